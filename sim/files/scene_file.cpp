// Loads a scene: document, overrides, then the table of keys; all problems are found before the first is thrown.
#include "sim/files/scene_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "sim/error.hpp"
#include "sim/files/local_origin.hpp"
#include "sim/files/scene_reader.hpp"

namespace understory {
namespace {

struct Decoded {
  Scene scene;
  std::vector<std::string> problems;
};

std::vector<std::string> in_order(std::vector<ReadContext::Problem> problems) {
  const auto key = [](const ReadContext::Problem& p) { return std::tie(p.place.source, p.place.line, p.place.column); };
  std::stable_sort(problems.begin(), problems.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  std::vector<std::string> texts;
  for (ReadContext::Problem& problem : problems) texts.push_back(std::move(problem.text));
  return texts;
}

Decoded decode(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  Document document = read_document(file);
  for (const std::string& assignment : overrides) apply_override(document, assignment);
  if (document.root->kind == Node::Kind::null) document.root->kind = Node::Kind::map;  // an empty file: nothing to see
  if (document.root->kind != Node::Kind::map) {
    throw Error(ErrorKind::invalid_input, file.string() + ":1: a scene file must be a map of keys");
  }
  Decoded result;
  ReadContext context{document, std::filesystem::absolute(file).parent_path(), {}, {}};
  SceneReader reader(context, *document.root, "");
  keys(reader, result.scene);
  reader.finish();
  result.scene.file = std::filesystem::absolute(file).lexically_normal();
  if (result.scene.name.empty()) result.scene.name = file.stem().string();
  result.problems = in_order(std::move(context.problems));
  return result;
}

}  // namespace

Scene load_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  Decoded result = decode(file, overrides);
  if (result.problems.empty()) {
    if (const glm::dvec2 zero = local_zero(result.scene); zero != glm::dvec2(0)) move_zero(result.scene, zero);
    return std::move(result.scene);
  }
  const std::size_t more = result.problems.size() - 1;
  const std::string rest = more ? fmt::format(" (and {} more: `understory validate` lists them all)", more) : "";
  throw Error(ErrorKind::invalid_input, result.problems.front() + rest);
}

Methods load_methods(const std::vector<std::string>& overrides) {
  Document document;
  document.root = std::make_shared<Node>();
  document.root->kind = Node::Kind::map;
  document.sources = {"no scene"};
  for (const std::string& assignment : overrides) apply_override(document, assignment);
  ReadContext context{document, {}, {}, {}};
  SceneReader reader(context, *document.root, "");
  Methods methods;
  reader.record("methods", methods, "");
  reader.finish();
  if (!context.problems.empty()) throw Error(ErrorKind::invalid_input, in_order(std::move(context.problems)).front());
  return methods;
}

std::vector<std::string> validate_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  try {
    return decode(file, overrides).problems;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::invalid_input) throw;
    return {error.what()};
  }
}

}  // namespace understory
