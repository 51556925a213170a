// A scene file as a tree of text with the place of every key and value, before anything is given a type.
// yaml-cpp is used as a tokenizer only: on its own it keeps the first of two equal keys and reads `010` as 8.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace understory {

/// Caps on a scene file. A million nodes is some 100,000 hand-placed plants.
inline constexpr std::uint64_t largest_scene_bytes = std::uint64_t{16} << 20;
inline constexpr std::uint64_t largest_scene_nodes = 1'000'000;  // with every alias written out
inline constexpr int deepest_scene_nesting = 32;

/// Where a key or value was written.
struct Place {
  std::uint32_t source = 0;            // index in Document::sources
  std::uint32_t line = 0, column = 0;  // from 1; 0: not in a file
};

struct Node {
  enum class Kind { null, scalar, list, map } kind = Kind::null;
  std::string text;     // scalars
  bool quoted = false;  // a quoted scalar is text, never a number
  struct Key {
    std::string name;
    Place place;
  };
  std::vector<Key> keys;                     // maps, in the order of the file, duplicates included
  std::vector<std::shared_ptr<Node>> items;  // values of lists and maps; aliases share
  Place place;
  std::uint64_t nodes = 1;  // in this subtree, aliases written out

  /// Value of the first key of that name, or null.
  const Node* find(const std::string& name) const;
};

struct Document {
  std::shared_ptr<Node> root;
  std::vector<std::string> sources;  // [0] the file, then one per override

  /// `file:line:column`, or the override.
  std::string describe(const Place& place) const;
};

/// Parses a file: `.json` as JSON, anything else as YAML. Throws Error(invalid_input) with file, line and column.
Document read_document(const std::filesystem::path& file);

/// Applies `wind.speed=4.2`: sets or, with `null`, removes one value. Throws Error(invalid_input) naming the override.
void apply_override(Document& document, const std::string& assignment);

}  // namespace understory
