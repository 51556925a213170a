// CBOR (RFC 8949): JSON for the row, and planes as bytes of floats, little-endian as the machine that wrote them.
#include "bench/tradeoff_store.hpp"

#include <cctype>
#include <cstring>
#include <fstream>
#include <iterator>

#include "bench/tradeoff_json.hpp"
#include "sim/error.hpp"
#include "sim/files/atomic_file.hpp"
#include "sim/files/json_fields.hpp"

namespace understory {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json binary(const std::vector<T>& values) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(values.data());
  return Json::binary(std::vector<std::uint8_t>(bytes, bytes + values.size() * sizeof(T)));
}

template <class T>
std::vector<T> from_binary(const Json& json) {
  const auto& bytes = json.get_binary();
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

constexpr JsonFields samples_fields{
    JsonField{"device_ms", &ShadingSamples::device_ms}, JsonField{"wall_ms", &ShadingSamples::wall_ms},
    JsonField{"pass_ms", &ShadingSamples::pass_ms}, JsonField{"pass_wall_ms", &ShadingSamples::pass_wall_ms},
    JsonField{"draw_ms", &ShadingSamples::draw_ms}};

Json to_json(const VariantRecord& record, const std::string& identity) {
  Json terms = Json::object();
  for (const auto& [name, plane] : record.values.terms) terms[name] = binary(plane);
  return {{"identity", identity},
          {"row", row_json(record.row)},
          {"sweeps", record.sweeps},
          {"samples", samples_fields.write(record.samples)},
          {"visibility", binary(record.values.visibility)},
          {"classes", binary(record.values.classes)},
          {"terms", terms}};
}

VariantRecord from_json(const Json& json) {
  VariantRecord record;
  record.row = row_from_json(json.at("row"));
  json.at("sweeps").get_to(record.sweeps);
  samples_fields.read(json.at("samples"), record.samples);
  record.values.visibility = from_binary<float>(json.at("visibility"));
  record.values.classes = from_binary<JudgedClass>(json.at("classes"));
  for (const auto& [name, plane] : json.at("terms").items()) record.values.terms[name] = from_binary<float>(plane);
  return record;
}

}  // namespace

std::string variant_file_name(const std::string& variant_name, const std::string& extension) {
  std::string name;
  for (const char c : variant_name) {
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '-')
      name += c;
    else if (c == '/')
      name += "of";
    else if (!name.ends_with('_'))
      name += '_';
  }
  return name + extension;
}

TradeoffStore::TradeoffStore(std::filesystem::path folder, std::string identity)
    : folder_(std::move(folder)), identity_(std::move(identity)) {}

std::filesystem::path TradeoffStore::file_of(const std::string& variant_name) const {
  return folder_ / variant_file_name(variant_name, ".cbor");
}

std::optional<VariantRecord> TradeoffStore::load(const std::string& variant_name) const {
  if (folder_.empty()) return std::nullopt;
  std::ifstream file(file_of(variant_name), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (bytes.empty()) return std::nullopt;
  try {
    const Json json = Json::from_cbor(bytes);
    if (json.at("identity").get<std::string>() != identity_) return std::nullopt;
    VariantRecord record = from_json(json);
    return record.row.name == variant_name ? std::optional(std::move(record)) : std::nullopt;
  } catch (const nlohmann::json::exception&) {  // damaged: measured anew
    return std::nullopt;
  } catch (const Error&) {
    return std::nullopt;
  }
}

void TradeoffStore::save(const VariantRecord& record) const {
  if (folder_.empty()) return;
  std::error_code ignored;  // told by the writer
  std::filesystem::create_directories(folder_, ignored);
  const std::vector<std::uint8_t> bytes = Json::to_cbor(to_json(record, identity_));
  write_file_atomically(file_of(record.row.name),
                        std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

}  // namespace understory
