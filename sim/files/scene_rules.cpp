// The reader's rules about which keys must, may or must not stand together.
#include <fmt/format.h>

#include <algorithm>

#include "sim/files/scene_reader.hpp"
#include "sim/files/text.hpp"

namespace understory {
namespace {

std::string list_of(std::initializer_list<const char*> names) { return join({names.begin(), names.end()}, ", "); }

}  // namespace

void SceneReader::require(std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (!node_.find(name)) report(node_.place, at(name), "missing", "this key is required");
  }
}

void SceneReader::require_all() {
  for (const std::string& name : std::vector<std::string>(known_)) require({name.c_str()});
}

void SceneReader::exactly_one(std::initializer_list<const char*> names) {
  std::vector<std::string> given;
  for (const char* name : names) {
    if (node_.find(name)) given.emplace_back(name);
  }
  if (given.size() == 1) return;
  const std::string value =
      given.empty() ? "none of these keys is given" : join(given, " and ") + " are given together";
  report(given.empty() ? node_.place : place_of(given[1].c_str()), path_, value,
         "allowed is exactly one of: " + list_of(names));
}

void SceneReader::at_least_one(std::initializer_list<const char*> names) {
  const bool any = std::any_of(names.begin(), names.end(), [&](const char* name) {
    const Node* node = node_.find(name);
    return node && (node->kind == Node::Kind::map || (node->kind == Node::Kind::list && !node->items.empty()));
  });
  if (!any) report(node_.place, path_, "nothing to see", "needed is at least one of: " + list_of(names));
}

void SceneReader::goes_with(const char* key, std::initializer_list<const char*> others) {
  if (node_.find(key)) return;
  for (const char* other : others) {
    if (node_.find(other)) report(place_of(other), at(other), "given", fmt::format("allowed only beside '{}'", key));
  }
}

void SceneReader::excludes(const char* key, std::initializer_list<const char*> others) {
  if (!node_.find(key)) return;
  for (const char* other : others) {
    if (node_.find(other)) report(place_of(other), at(other), "given", fmt::format("not allowed beside '{}'", key));
  }
}

void SceneReader::check(bool holds, const char* key, const std::string& allowed) {
  if (holds) return;
  const Node* node = node_.find(key);
  std::string value = "not given";
  if (node) value = node->kind == Node::Kind::scalar ? readable(node->text) : "as written";
  report(place_of(key), at(key), value, "allowed is " + allowed);
}

}  // namespace understory
