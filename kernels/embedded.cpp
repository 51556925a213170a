// Looks up embedded kernel sources and pastes their includes: textual, by name, each file once.
#include "kernels/embedded.hpp"

#include <algorithm>
#include <set>
#include <span>

#include "kernels/embedded_table.hpp"
#include "sim/error.hpp"

namespace understory {
namespace {

std::span<const EmbeddedFile> files() { return {embedded_files, embedded_file_count}; }

std::string_view without_prefix(std::string_view name) {
  constexpr std::string_view prefix = "kernels/";
  return name.starts_with(prefix) ? name.substr(prefix.size()) : name;
}

/// Name inside the quotes of an `#include "name"` line; empty for any other line.
std::string_view included_name(std::string_view line) {
  const auto skip_blanks = [&] { line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size())); };
  const auto take = [&](std::string_view word) {
    skip_blanks();
    if (!line.starts_with(word)) return false;
    line.remove_prefix(word.size());
    return true;
  };
  if (!take("#") || !take("include") || !take("\"")) return {};
  return line.substr(0, line.find('"'));
}

void append_file(std::string_view name, std::set<std::string_view>& seen, std::string& text) {
  name = without_prefix(name);
  std::string_view rest = embedded_source(name);
  if (!seen.insert(name).second) return;
  const std::string line_directive = " \"kernels/" + std::string(name) + "\"\n";
  text += "#line 1" + line_directive;
  for (int number = 1; !rest.empty(); ++number) {
    const std::size_t end = std::min(rest.find('\n'), rest.size() - 1);
    const std::string_view line = rest.substr(0, end + 1);
    rest.remove_prefix(end + 1);
    const std::string_view included = included_name(line);
    if (included.empty()) {
      text += line;
    } else {
      append_file(included, seen, text);
      text += "#line " + std::to_string(number + 1) + line_directive;
    }
  }
  if (!text.ends_with('\n')) text += '\n';
}

}  // namespace

std::vector<std::string> embedded_programs() {
  std::vector<std::string> programs;
  for (const EmbeddedFile& file : files()) {
    if (file.name.ends_with(".cl")) programs.emplace_back(file.name.substr(0, file.name.size() - 3));
  }
  std::sort(programs.begin(), programs.end());
  return programs;
}

std::string_view embedded_source(std::string_view name) {
  const std::string_view wanted = without_prefix(name);
  for (const EmbeddedFile& file : files()) {
    if (file.name == wanted) return file.text;
  }
  std::string message = "no kernel source '" + std::string(name) + "' is embedded; there are:";
  for (const EmbeddedFile& file : files()) message.append(" ").append(file.name);
  throw Error(ErrorKind::unexpected, message);
}

std::string expanded_source(std::string_view program) {
  std::set<std::string_view> seen;
  std::string text;
  append_file(std::string(program) + ".cl", seen, text);
  return text;
}

}  // namespace understory
