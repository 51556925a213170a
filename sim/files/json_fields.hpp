// The keys of a record in JSON, named once for writing and for reading.
#pragma once
#include <nlohmann/json.hpp>
#include <tuple>

namespace understory {

template <class Record, class Value>
struct JsonField {
  const char* key;
  Value Record::*member;
};

/// Members of a record by their keys: `constexpr JsonFields spread_fields{JsonField{"low", &Spread95::low}, ...};`.
template <class Record, class... Values>
class JsonFields {
 public:
  constexpr explicit JsonFields(JsonField<Record, Values>... fields) : fields_(fields...) {}

  /// An object of these keys, in their order.
  nlohmann::ordered_json write(const Record& record) const {
    nlohmann::ordered_json json;
    std::apply([&](const auto&... field) { ((json[field.key] = record.*field.member), ...); }, fields_);
    return json;
  }
  /// Throws nlohmann::json::exception for a key that is missing or of another type; others are passed over.
  void read(const nlohmann::ordered_json& json, Record& record) const {
    std::apply([&](const auto&... field) { (json.at(field.key).get_to(record.*field.member), ...); }, fields_);
  }
  Record read(const nlohmann::ordered_json& json) const {
    Record record;
    read(json, record);
    return record;
  }

 private:
  std::tuple<JsonField<Record, Values>...> fields_;
};

}  // namespace understory
