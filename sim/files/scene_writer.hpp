// The archive that puts a scene back into text: every key with its value, angles in degrees, as JSON.
#pragma once
#include <nlohmann/json.hpp>
#include <type_traits>

#include "sim/files/scene_file.hpp"
#include "sim/files/scene_keys.hpp"

namespace understory {

class SceneWriter {
 public:
  explicit SceneWriter(PathStyle paths) : paths_(paths) {}
  nlohmann::ordered_json json = nlohmann::ordered_json::object();

  void number(const char* key, double& value, const Range& range, const char* help);
  void numbers(const char* key, std::span<double> values, const Range& range, const char* help);
  void numbers(const char* key, std::span<float> values, const Range& range, const char* help);
  void integer(const char* key, int& value, int low, int high, const char* help, int unset = -1) {
    static_cast<void>(low), static_cast<void>(high), static_cast<void>(help);
    if (value != unset) json[key] = value;
  }
  void integer(const char* key, std::uint64_t& value, std::uint64_t, std::uint64_t, const char*) { json[key] = value; }
  void flag(const char* key, bool& value, const char*) { json[key] = value; }
  void text(const char* key, std::string& value, const char*) {
    if (!value.empty()) json[key] = value;
  }
  void texts(const char* key, std::vector<std::string>& values, const char*) { json[key] = values; }
  void word(const char* key, std::string& value, Words, const char* help) { text(key, value, help); }
  void file(const char* key, std::filesystem::path& value, const char*);
  void up_axis(const char* key, UpAxis& value, const std::filesystem::path&) {
    json[key] = value == UpAxis::y ? "y" : "z";
  }
  void reference(const char* key, std::string& value, const char*, const char*) { json[key] = value; }

  void require(std::initializer_list<const char*>) {}
  void exactly_one(std::initializer_list<const char*>) {}
  void at_least_one(std::initializer_list<const char*>) {}
  void goes_with(const char* key, std::initializer_list<const char*> others) {
    if (!json.contains(key)) erase(others);
  }
  void excludes(const char* key, std::initializer_list<const char*> others) {
    if (json.contains(key)) erase(others);
  }
  void check(bool, const char*, const std::string&) {}

  template <class Enum>
  void choice(const char* key, Enum& value, Choices<Enum> choices, const char*) {
    for (const auto& [one, name] : choices) {
      if (one == value) json[key] = name;
    }
  }

  template <class Value>
  bool alternative(const char*, Value& field, std::type_identity_t<Value> value) {
    return field == value;
  }

  template <class Walk>
  void section(const char* key, const char*, Walk walk, bool written = true) {
    if (!written) return;
    SceneWriter writer(paths_);
    walk(writer);
    if (!writer.json.empty()) json[key] = std::move(writer.json);
  }

  template <class Walk>
  void section_unless(const char* key, const char* word, bool& present, const char* help, Walk walk) {
    if (present) {
      section(key, help, walk);
    } else {
      json[key] = word;
    }
  }

  template <class Record>
  void record(const char* key, Record& value, const char* help) {
    section(key, help, [&](SceneWriter& writer) { keys(writer, value); });
  }

  template <class Record>
  void optional(const char* key, std::optional<Record>& value, const char* help) {
    if (value) record(key, *value, help);
  }

  template <class Record>
  void list(const char* key, std::vector<Record>& values, const char*, std::size_t = 0) {
    json[key] = nlohmann::ordered_json::array();
    for (Record& value : values) {
      SceneWriter item(paths_);
      keys(item, value);
      json[key].push_back(std::move(item.json));
    }
  }

  template <class Record>
  void named(const char* key, std::vector<Record>& values, const char* help) {
    section(key, help, [&](SceneWriter& map) {
      for (Record& value : values) map.record(value.name.c_str(), value, "");
    });
  }

 private:
  void erase(std::initializer_list<const char*> others) {
    for (const char* other : others) json.erase(other);
  }

  PathStyle paths_;
};

}  // namespace understory
