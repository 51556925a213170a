// Typed decoding of scene values: what counts as a number, a word, a path, and the message when it is none.
#include "sim/files/scene_reader.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <glm/gtc/constants.hpp>
#include <regex>

#include "sim/files/text.hpp"

namespace understory {
namespace {

constexpr std::size_t most_problems = 200;  // enough to show what is wrong with a generated file
constexpr std::size_t longest_text = 200;

std::string value_text(const Node& node) {
  switch (node.kind) {
    case Node::Kind::null:
      return "no value";
    case Node::Kind::list:
      return fmt::format("a list of {}", node.items.size());
    case Node::Kind::map:
      return "a map";
    case Node::Kind::scalar:
      break;
  }
  return node.quoted ? '"' + readable(node.text) + '"' : readable(node.text);
}

std::string describe(const Range& range) {
  const char* space = *range.unit ? " " : "";
  if (range.above_low) return fmt::format("a number above {} up to {}{}{}", range.low, range.high, space, range.unit);
  return fmt::format("a number from {} to {}{}{}", range.low, range.high, space, range.unit);
}

/// Decimal numbers of YAML 1.2 and JSON; `010` (octal to some readers), `0x10`, `1_000` and words are none.
bool looks_decimal(const std::string& text) {
  std::size_t i = text.find_first_not_of("+-");
  if (i == std::string::npos || i > 1 || !(std::isdigit(static_cast<unsigned char>(text[i])) || text[i] == '.')) {
    return false;
  }
  if (text[i] == '0' && i + 1 < text.size() && std::isdigit(static_cast<unsigned char>(text[i + 1]))) return false;
  return text.find_first_not_of("0123456789.eE+-", i) == std::string::npos;
}

template <class Number>
std::optional<Number> parse(const Node& node) {
  if (node.kind != Node::Kind::scalar || node.quoted || !looks_decimal(node.text)) return std::nullopt;
  const char* begin = node.text.data() + (node.text[0] == '+' ? 1 : 0);
  const char* end = node.text.data() + node.text.size();
  Number value{};
  const auto [stop, failure] = std::from_chars(begin, end, value);
  if (failure != std::errc() || stop != end) return std::nullopt;
  return value;
}

UpAxis usual_up_axis(const std::filesystem::path& mesh) {
  const bool is_ply = matches_pattern(mesh.extension().string(), ".ply");
  return is_ply ? UpAxis::z : UpAxis::y;
}

std::string quoted_list(const std::vector<std::string>& words) { return join(words, ", "); }

}  // namespace

SceneReader::SceneReader(ReadContext& context, const Node& node, std::string path)
    : context_(context), node_(node), path_(std::move(path)) {}

void SceneReader::report(const Place& place, const std::string& path, const std::string& value,
                         const std::string& allowed) {
  if (context_.problems.size() >= most_problems) return;
  const std::string where = context_.document.describe(place);
  context_.problems.push_back(
      {place, fmt::format("{}: {}: {}: {}", where, path.empty() ? "scene" : path, value, allowed)});
}

const Node* SceneReader::find(const char* key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
  return node_.find(key);
}

Place SceneReader::place_of(const char* key) const {
  const Node* value = node_.find(key);
  return value ? value->place : node_.place;
}

void SceneReader::finish() {
  std::set<std::string> seen;
  for (const Node::Key& key : node_.keys) {
    if (!seen.insert(key.name).second) {
      const auto first = std::find_if(node_.keys.begin(), node_.keys.end(),
                                      [&](const Node::Key& other) { return other.name == key.name; });
      report(key.place, at(readable(key.name)), "duplicate key",
             fmt::format("allowed once, and it is at {}", context_.document.describe(first->place)));
    } else if (std::find(known_.begin(), known_.end(), key.name) == known_.end()) {
      const std::string meant = closest_word(key.name, known_);
      const std::string hint = meant.empty() ? "" : fmt::format("did you mean '{}'? ", meant);
      report(key.place, at(readable(key.name)), "unknown key", fmt::format("{}allowed: {}", hint, quoted_list(known_)));
    }
  }
}

std::optional<double> SceneReader::decode_number(const Node& node, const std::string& path, const Range& range) {
  const std::optional<double> value = parse<double>(node);
  const bool allowed = value && std::isfinite(*value) && *value <= range.high &&
                       (range.above_low ? *value > range.low : *value >= range.low);
  if (allowed) return range.is_angle ? *value * (glm::pi<double>() / 180) : *value;
  report(node.place, path, value_text(node), "allowed is " + describe(range));
  return std::nullopt;
}

void SceneReader::number(const char* key, double& value, const Range& range, const char*) {
  if (const Node* node = find(key)) value = decode_number(*node, at(key), range).value_or(value);
}

template <class Float>
void SceneReader::read_numbers(const char* key, std::span<Float> values, const Range& range) {
  const Node* node = find(key);
  if (!node) return;
  if (node->kind != Node::Kind::list || node->items.size() != values.size()) {
    report(node->place, at(key), value_text(*node), fmt::format("allowed is a list of {} numbers", values.size()));
    return;
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::optional<double> value = decode_number(*node->items[i], at(key) + '.' + std::to_string(i), range);
    if (value) values[i] = static_cast<Float>(*value);
  }
}

void SceneReader::numbers(const char* key, std::span<double> values, const Range& range, const char*) {
  read_numbers(key, values, range);
}

void SceneReader::numbers(const char* key, std::span<float> values, const Range& range, const char*) {
  read_numbers(key, values, range);
}

template <class Integer>
void SceneReader::read_integer(const char* key, Integer& value, Integer low, Integer high) {
  const Node* node = find(key);
  if (!node) return;
  const std::optional<Integer> number = parse<Integer>(*node);
  if (number && *number >= low && *number <= high) {
    value = *number;
  } else {
    report(node->place, at(key), value_text(*node), fmt::format("allowed is a whole number from {} to {}", low, high));
  }
}

void SceneReader::integer(const char* key, int& value, int low, int high, const char*, int) {
  read_integer(key, value, low, high);
}

void SceneReader::integer(const char* key, std::uint64_t& value, std::uint64_t low, std::uint64_t high, const char*) {
  read_integer(key, value, low, high);
}

void SceneReader::flag(const char* key, bool& value, const char*) {
  const Node* node = find(key);
  if (!node) return;
  const bool is_flag =
      node->kind == Node::Kind::scalar && !node->quoted && (node->text == "true" || node->text == "false");
  if (is_flag) {
    value = node->text == "true";
  } else {
    report(node->place, at(key), value_text(*node), "allowed is true or false");
  }
}

std::optional<std::string> SceneReader::decode_text(const Node& node, const std::string& path) {
  const bool is_plain_word = node.kind == Node::Kind::scalar && !node.quoted;
  const bool other_type = is_plain_word && (parse<double>(node) || node.text == "true" || node.text == "false");
  if (node.kind != Node::Kind::scalar || other_type || node.text.empty() || node.text.size() > longest_text) {
    report(node.place, path, value_text(node),
           fmt::format("allowed is text of 1 to {} bytes, in quotes if it looks like something else", longest_text));
    return std::nullopt;
  }
  return node.text;
}

void SceneReader::text(const char* key, std::string& value, const char*) {
  if (const Node* node = find(key)) value = decode_text(*node, at(key)).value_or(value);
}

void SceneReader::texts(const char* key, std::vector<std::string>& values, const char*) {
  const Node* node = find(key);
  if (!node || !is_list(*node, at(key), 0)) return;
  values.clear();
  for (std::size_t i = 0; i < node->items.size(); ++i) {
    const auto text = decode_text(*node->items[i], at(key) + '.' + std::to_string(i));
    if (text) values.push_back(*text);
  }
}

std::string SceneReader::chosen_word(const char* key, const std::vector<std::string>& allowed) {
  const Node* node = find(key);
  if (!node) return {};
  if (node->kind == Node::Kind::scalar && std::find(allowed.begin(), allowed.end(), node->text) != allowed.end()) {
    return node->text;
  }
  const std::string meant = node->kind == Node::Kind::scalar ? closest_word(node->text, allowed) : "";
  const std::string hint = meant.empty() ? "" : fmt::format("did you mean '{}'? ", meant);
  report(node->place, at(key), value_text(*node), fmt::format("{}allowed: {}", hint, quoted_list(allowed)));
  return {};
}

void SceneReader::word(const char* key, std::string& value, Words allowed, const char*) {
  const std::string chosen = chosen_word(key, {allowed.begin(), allowed.end()});
  if (!chosen.empty()) value = chosen;
}

void SceneReader::reference(const char* key, std::string& value, const char* named_key, const char*) {
  const Node* node = find(key);
  if (!node) return;
  const std::optional<std::string> text = decode_text(*node, at(key));
  if (!text) return;
  const std::vector<std::string>& names = context_.names[named_key];
  value = *text;
  if (std::find(names.begin(), names.end(), value) != names.end()) return;
  const std::string meant = closest_word(value, names);
  const std::string hint = meant.empty() ? "" : fmt::format("did you mean '{}'? ", meant);
  report(node->place, at(key), value_text(*node),
         names.empty() ? fmt::format("allowed is a name from '{}', which is empty", named_key)
                       : fmt::format("{}allowed: {}", hint, quoted_list(names)));
}

void SceneReader::file(const char* key, std::filesystem::path& value, const char*) {
  const Node* node = find(key);
  if (!node) return;
  const std::optional<std::string> text = decode_text(*node, at(key));
  if (!text) return;
  std::filesystem::path path = *text;
  static const std::regex variable(R"(^\$\{([A-Za-z_][A-Za-z0-9_]*)\})");
  if (std::smatch match; std::regex_search(*text, match, variable)) {
    const char* folder = std::getenv(match[1].str().c_str());
    if (!folder || !*folder) {
      report(node->place, at(key), value_text(*node),
             fmt::format("the environment variable {} is not set: it must name a folder", match[1].str()));
      return;
    }
    path = folder + match.suffix().str();
  }
  value = std::filesystem::absolute(path.is_absolute() ? path : context_.folder / path).lexically_normal();
  std::error_code failure;
  if (!std::filesystem::is_regular_file(value, failure)) {
    report(node->place, at(key), value_text(*node), fmt::format("there is no such file: {}", value.string()));
  }
}

void SceneReader::up_axis(const char* key, UpAxis& value, const std::filesystem::path& mesh) {
  if (!mesh.empty() && !node_.find(key)) value = usual_up_axis(mesh);
  choice(key, value, {{UpAxis::y, "y"}, {UpAxis::z, "z"}}, "");
}

bool SceneReader::is_list(const Node& node, const std::string& path, std::size_t least) {
  if (node.kind == Node::Kind::list && node.items.size() >= least) return true;
  report(node.place, path, value_text(node),
         least ? fmt::format("allowed is a list of {} or more", least) : "allowed is a list");
  return false;
}

bool SceneReader::is_map(const Node& node, const std::string& path) {
  if (node.kind == Node::Kind::map) return true;
  report(node.place, path, value_text(node), "allowed is a map of keys");
  return false;
}

void SceneReader::check_names(const char* key) {
  static const std::regex name("[A-Za-z_][A-Za-z0-9_-]{0,63}");
  for (const Node::Key& each : node_.keys) {
    known_.push_back(each.name);
    context_.names[key].push_back(each.name);
    if (!std::regex_match(each.name, name)) {
      report(each.place, at(readable(each.name)), "not a name",
             "allowed is a letter or _, then letters, digits, _ and -, 64 at most");
    }
  }
}

}  // namespace understory
