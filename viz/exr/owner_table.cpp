// Owner rows to JSON objects and back, one compact line.
#include "viz/exr/owner_table.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "sim/error.hpp"

namespace understory {
namespace {

constexpr SurfaceClass surface_classes[] = {SurfaceClass::background, SurfaceClass::terrain, SurfaceClass::leaf,
                                            SurfaceClass::wood,       SurfaceClass::blade,   SurfaceClass::occluder};

SurfaceClass surface_class_from(const std::string& name) {
  for (const SurfaceClass surface : surface_classes)
    if (name == surface_class_name(surface)) return surface;
  throw Error(ErrorKind::invalid_input, fmt::format("unknown class `{}`", name));
}

Owner owner_from(const nlohmann::json& row) {
  Owner owner;
  owner.surface = surface_class_from(row.at("class").get<std::string>());
  owner.species = row.at("species").get<std::string>();
  owner.instance = row.at("instance").get<std::int32_t>();
  for (int channel = 0; channel < 3; ++channel) owner.albedo[channel] = row.at("albedo").at(channel).get<float>();
  owner.crown = row.at("crown").get<std::int32_t>();
  owner.group = row.at("group").get<std::int32_t>();
  return owner;
}

}  // namespace

std::string owners_to_json(const std::vector<Owner>& owners) {
  auto rows = nlohmann::json::array();
  for (const Owner& owner : owners)
    rows.push_back({{"class", surface_class_name(owner.surface)},
                    {"species", owner.species},
                    {"instance", owner.instance},
                    {"albedo", {owner.albedo.x, owner.albedo.y, owner.albedo.z}},
                    {"crown", owner.crown},
                    {"group", owner.group}});
  return rows.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::vector<Owner> owners_from_json(const std::string& text) {
  std::vector<Owner> owners;
  try {
    for (const auto& row : nlohmann::json::parse(text)) owners.push_back(owner_from(row));
  } catch (const std::exception& error) {
    throw Error(ErrorKind::invalid_input, fmt::format("owner table, row {}: {}", owners.size(), error.what()));
  }
  return owners;
}

}  // namespace understory
