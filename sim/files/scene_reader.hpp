// The archive that decodes: walks the table of keys over one map of a document, checks and converts each value, and
// notes every problem with its place instead of stopping at the first.
#pragma once
#include <map>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include "sim/files/document.hpp"
#include "sim/files/scene_keys.hpp"

namespace understory {

/// What all readers of one scene share.
struct ReadContext {
  const Document& document;
  std::filesystem::path folder;  // relative paths start here
  struct Problem {
    Place place;
    std::string text;
  };
  std::vector<Problem> problems;
  std::map<std::string, std::vector<std::string>> names;  // keys of each `named` map, for `reference`
};

class SceneReader {
 public:
  /// `node` must be a map. `path` is its dotted key, empty for the whole file.
  SceneReader(ReadContext& context, const Node& node, std::string path);
  /// Reports unknown and duplicate keys: call it when the table has been walked.
  void finish();

  void number(const char* key, double& value, const Range& range, const char* help);
  void numbers(const char* key, std::span<double> values, const Range& range, const char* help);
  void numbers(const char* key, std::span<float> values, const Range& range, const char* help);
  void integer(const char* key, int& value, int low, int high, const char* help, int unset = 0);
  void integer(const char* key, std::uint64_t& value, std::uint64_t low, std::uint64_t high, const char* help);
  void flag(const char* key, bool& value, const char* help);
  void text(const char* key, std::string& value, const char* help);
  void texts(const char* key, std::vector<std::string>& values, const char* help);
  void word(const char* key, std::string& value, Words allowed, const char* help);
  void file(const char* key, std::filesystem::path& value, const char* help);
  void up_axis(const char* key, UpAxis& value, const std::filesystem::path& mesh);
  void reference(const char* key, std::string& value, const char* named_key, const char* help);

  void require(std::initializer_list<const char*> names);
  void exactly_one(std::initializer_list<const char*> names);
  void at_least_one(std::initializer_list<const char*> names);
  void goes_with(const char* key, std::initializer_list<const char*> others);
  void excludes(const char* key, std::initializer_list<const char*> others);
  void check(bool holds, const char* key, const std::string& allowed);

  template <class Enum>
  void choice(const char* key, Enum& value, Choices<Enum> choices, const char*) {
    std::vector<std::string> names;
    for (const auto& [_, name] : choices) names.push_back(name);
    const std::string chosen = chosen_word(key, names);
    for (const auto& [one, name] : choices) {
      if (chosen == name) value = one;
    }
  }

  template <class Value>
  bool alternative(const char* key, Value& field, std::type_identity_t<Value> value) {
    if (!node_.find(key)) return false;
    field = value;
    return true;
  }

  template <class Walk>
  void section(const char* key, const char*, Walk walk, bool = true) {
    if (const Node* node = find(key)) read_map(*node, at(key), walk);
  }

  template <class Walk>
  void section_unless(const char* key, const char* word, bool& present, const char* help, Walk walk) {
    const Node* node = find(key);
    present = !(node && node->kind == Node::Kind::scalar && node->text == word);
    if (node && present && node->kind != Node::Kind::map) {
      check(false, key, std::string("'") + word + "' or a map of keys");
    } else if (present) {
      section(key, help, walk);
    }
  }

  template <class Record>
  void record(const char* key, Record& value, const char* help) {
    section(key, help, [&](SceneReader& reader) { keys(reader, value); });
  }

  template <class Record>
  void optional(const char* key, std::optional<Record>& value, const char* help) {
    section(key, help, [&](SceneReader& reader) {
      value.emplace();
      keys(reader, *value);
      reader.require_all();
    });
  }

  template <class Record>
  void list(const char* key, std::vector<Record>& values, const char*, std::size_t least = 0) {
    const Node* node = find(key);
    if (!node || !is_list(*node, at(key), least)) return;
    values.assign(node->items.size(), Record{});
    for (std::size_t i = 0; i < values.size(); ++i) {
      read_map(*node->items[i], at(key) + '.' + std::to_string(i), [&](SceneReader& item) { keys(item, values[i]); });
    }
  }

  template <class Record>
  void named(const char* key, std::vector<Record>& values, const char* help) {
    section(key, help, [&](SceneReader& map) {
      map.check_names(key);
      for (std::size_t i = 0; i < map.node_.keys.size(); ++i) {
        Record& value = values.emplace_back();
        value.name = map.node_.keys[i].name;
        read_map(*map.node_.items[i], map.at(value.name), [&](SceneReader& item) { keys(item, value); });
      }
    });
  }

 private:
  const Node* find(const char* key);
  std::string at(const std::string& key) const { return path_.empty() ? key : path_ + '.' + key; }
  Place place_of(const char* key) const;
  void report(const Place& place, const std::string& path, const std::string& value, const std::string& allowed);
  std::optional<double> decode_number(const Node& node, const std::string& path, const Range& range);
  template <class Float>
  void read_numbers(const char* key, std::span<Float> values, const Range& range);
  template <class Integer>
  void read_integer(const char* key, Integer& value, Integer low, Integer high);
  std::optional<std::string> decode_text(const Node& node, const std::string& path);
  std::string chosen_word(const char* key, const std::vector<std::string>& allowed);
  bool is_list(const Node& node, const std::string& path, std::size_t least);
  bool is_map(const Node& node, const std::string& path);
  void check_names(const char* key);
  void require_all();

  template <class Walk>
  void read_map(const Node& node, const std::string& path, Walk walk) {
    if (!is_map(node, path)) return;
    SceneReader reader(context_, node, path);
    walk(reader);
    reader.finish();
  }

  ReadContext& context_;
  const Node& node_;
  std::string path_;
  std::vector<std::string> known_;  // keys that the table has asked for
};

}  // namespace understory
