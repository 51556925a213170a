// The archive that describes: JSON Schema (draft 7) and help text from the table of keys and the defaults of Scene.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "sim/files/scene_file.hpp"
#include "sim/files/scene_keys.hpp"

namespace understory {
namespace {

using Json = nlohmann::ordered_json;

class SchemaBuilder {
 public:
  Json schema = {{"type", "object"}, {"properties", Json::object()}, {"additionalProperties", false}};

  void number(const char* key, double& value, const Range& range, const char* help) {
    Json& property = add(key, number_type(range), help, range.unit);
    if (value != range.unset) set_default(key, property, shown(value, range));
  }
  template <class Float>
  void numbers(const char* key, std::span<Float> values, const Range& range, const char* help) {
    Json defaults = Json::array();
    for (const Float value : values) defaults.push_back(shown(static_cast<double>(value), range));
    Json& property = add(key, list_type(number_type(range), values.size(), values.size()), help, range.unit);
    set_default(key, property, defaults);
  }
  template <class Integer>
  void integer(const char* key, Integer& value, std::type_identity_t<Integer> low, std::type_identity_t<Integer> high,
               const char* help, int unset = -1) {
    Json& property = add(key, {{"type", "integer"}, {"minimum", low}, {"maximum", high}}, help);
    if (unset < 0 || value != static_cast<Integer>(unset)) set_default(key, property, value);
  }
  void flag(const char* key, bool& value, const char* help) {
    set_default(key, add(key, {{"type", "boolean"}}, help), value);
  }
  void text(const char* key, std::string&, const char* help) { add(key, text_type(), help); }
  void texts(const char* key, std::vector<std::string>& values, const char* help) {
    set_default(key, add(key, {{"type", "array"}, {"items", text_type()}}, help), values);
  }
  void word(const char* key, std::string& value, Words allowed, const char* help) {
    Json& property = add(key, {{"enum", Json(std::vector<std::string>(allowed.begin(), allowed.end()))}}, help);
    if (!value.empty()) set_default(key, property, value);
  }
  void file(const char* key, std::filesystem::path&, const char* help) { add(key, text_type(), help, "path"); }
  void up_axis(const char* key, UpAxis&, const std::filesystem::path&) {
    add(key, {{"enum", list_of({"y", "z"})}}, "the mesh's axis that is up; left out: z for PLY, y for OBJ and glTF");
  }
  void reference(const char* key, std::string&, const char*, const char* help) { add(key, text_type(), help); }

  void require(std::initializer_list<const char*> names) { schema.update(required(names)); }
  void exactly_one(std::initializer_list<const char*> names) {
    for (const char* name : names) schema["oneOf"].push_back(required({name}));
  }
  void at_least_one(std::initializer_list<const char*> names) {
    for (const char* name : names) {
      const Json something = {{"not", {{"enum", Json::array({"none", Json::array()})}}}};
      Json given = required({name});
      given["properties"][name] = something;
      schema["anyOf"].push_back(given);
    }
  }
  void goes_with(const char* key, std::initializer_list<const char*> others) {
    for (const char* other : others) schema["dependencies"][other] = list_of({key});
  }
  void excludes(const char* key, std::initializer_list<const char*> others) {
    Json any = Json::array();
    for (const char* other : others) any.push_back(required({other}));
    schema["dependencies"][key]["not"]["anyOf"] = any;
  }
  void check(bool, const char*, const std::string&) {}

  template <class Enum>
  void choice(const char* key, Enum& value, Choices<Enum> choices, const char* help) {
    Json names = Json::array(), current;
    for (const auto& [one, name] : choices) {
      names.push_back(name);
      if (one == value) current = name;
    }
    set_default(key, add(key, {{"enum", names}}, help), current);
  }

  template <class Value>
  bool alternative(const char*, Value&, std::type_identity_t<Value>) {
    return true;
  }

  template <class Walk>
  void section(const char* key, const char* help, Walk walk, bool = true) {
    add(key, object(walk), help);
  }
  template <class Walk>
  void section_unless(const char* key, const char* word, bool&, const char* help, Walk walk) {
    Json type = Json::object();
    type["oneOf"] = Json::array({Json{{"const", word}}, object(walk)});
    add(key, type, help);
  }
  template <class Record>
  void record(const char* key, Record& value, const char* help) {
    add(key, object([&](SchemaBuilder& builder) { keys(builder, value); }), help);
  }
  template <class Record>
  void optional(const char* key, std::optional<Record>&, const char* help) {
    Json type = described<Record>();
    Json names = Json::array();
    for (auto& [name, property] : type["properties"].items()) {
      names.push_back(name);
      property.erase("default");
    }
    type["required"] = names;
    add(key, type, help);
  }
  template <class Record>
  void list(const char* key, std::vector<Record>&, const char* help, std::size_t least = 0) {
    Json type = {{"type", "array"}, {"items", described<Record>()}};
    if (least > 0) type["minItems"] = least;
    add(key, type, help);
  }
  template <class Record>
  void named(const char* key, std::vector<Record>&, const char* help) {
    Json type = {{"type", "object"}, {"additionalProperties", described<Record>()}};
    type["propertyNames"] = {{"pattern", "^[A-Za-z_][A-Za-z0-9_-]{0,63}$"}};
    add(key, type, help);
  }

 private:
  static Json list_of(std::initializer_list<const char*> names) {
    return std::vector<std::string>(names.begin(), names.end());
  }
  static Json required(std::initializer_list<const char*> names) {
    Json rule = Json::object();
    rule["required"] = list_of(names);
    return rule;
  }
  static Json text_type() { return {{"type", "string"}, {"minLength", 1}, {"maxLength", 200}}; }
  static Json list_type(const Json& item, std::size_t least, std::size_t most) {
    return {{"type", "array"}, {"items", item}, {"minItems", least}, {"maxItems", most}};
  }
  static Json number_type(const Range& range) {
    return {{"type", "number"}, {range.above_low ? "exclusiveMinimum" : "minimum", range.low}, {"maximum", range.high}};
  }
  /// A default for people: six digits, degrees where files have degrees.
  static double shown(double value, const Range& range) {
    return std::stod(fmt::format("{:.6g}", range.is_angle ? value * (180 / glm::pi<double>()) : value));
  }
  template <class Walk>
  static Json object(Walk walk) {
    SchemaBuilder builder;
    walk(builder);
    return builder.schema;
  }
  template <class Record>
  static Json described() {
    Record value{};
    return object([&](SchemaBuilder& builder) { keys(builder, value); });
  }

  Json& add(const char* key, const Json& type, const std::string& help, const std::string& unit = "") {
    Json& property = schema["properties"][key];
    property["description"] = unit.empty() ? help : help + " [" + unit + "]";
    property.update(type);
    return property;
  }
  void set_default(const char* key, Json& property, const Json& value) const {
    const Json required = schema.value("required", Json::array());
    if (std::find(required.begin(), required.end(), key) == required.end()) property["default"] = value;
  }
};

Json build_schema() {
  Scene scene;
  SchemaBuilder builder;
  keys(builder, scene);
  Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"},
                 {"title", "Understory scene"},
                 {"description", "Made by the program from its own table of keys; SI units, angles in degrees."}};
  schema.update(builder.schema);
  return schema;
}

/// A number or list of numbers without needless digits: 0.5, 100, 1e+08.
std::string plain(const Json& value) {
  if (value.is_number_float()) return fmt::format("{}", value.get<double>());
  if (!value.is_array() || value.empty() || !value[0].is_number_float()) return value.dump();
  std::string list;
  for (const Json& one : value) list += (list.empty() ? "" : ", ") + plain(one);
  return '[' + list + ']';
}

std::string type_text(const Json& type) {
  if (type.contains("enum")) {
    std::string words;
    for (const Json& word : type["enum"]) words += (words.empty() ? "" : "|") + word.get<std::string>();
    return words;
  }
  if (type.value("type", "") == "array" && type.contains("maxItems")) {
    return fmt::format("{} x {}", type["maxItems"].dump(), type_text(type["items"]));
  }
  if (type.contains("maximum")) {
    const bool above = type.contains("exclusiveMinimum");
    const Json& low = above ? type["exclusiveMinimum"] : type["minimum"];
    return fmt::format("{} {}{} to {}", type["type"].get<std::string>(), above ? "above " : "", plain(low),
                       plain(type["maximum"]));
  }
  return type.value("type", "");
}

void describe_keys(const Json& object, const std::string& prefix, std::string& out) {
  for (const auto& [key, property] : object.at("properties").items()) {
    const Json& type = property.contains("oneOf") && !property.contains("type") ? property["oneOf"][1] : property;
    const bool is_list = type.contains("items") && type["items"].contains("properties");
    const bool is_named = type.contains("additionalProperties") && type["additionalProperties"].is_object();
    const std::string path = prefix + key;
    out += fmt::format("{:<40} {:<32} {}", path, is_named ? "names" : type_text(type),
                       property["description"].get<std::string>());
    if (property.contains("default")) out += fmt::format(" ({})", plain(property["default"]));
    out += '\n';
    if (is_named) describe_keys(type["additionalProperties"], path + ".NAME.", out);
    if (is_list) describe_keys(type["items"], path + ".N.", out);
    if (type.contains("properties")) describe_keys(type, path + '.', out);
  }
}

}  // namespace

std::string scene_json_schema() { return build_schema().dump(2) + '\n'; }

std::string scene_help() {
  std::string help;
  describe_keys(build_schema(), "", help);
  return help;
}

}  // namespace understory
