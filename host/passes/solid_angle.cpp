#include "host/passes/solid_angle.hpp"

#include <algorithm>

#include "kernels/shared/fragment_tiles.h"
#include "sim/error.hpp"

namespace understory {
namespace {

constexpr std::size_t longest_list = 256;  // spheres; a tile with more tries all of them

std::string share_option(const std::string& method) {
  if (method == "solid-angle") return "-DSHARE=unit_solid_angle";
  if (method == "solid-angle-exact") return "-DSHARE=unit_solid_angle_exact";
  if (method == "solid-angle-cosine" || method == "crown-shells") return "-DSHARE=unit_solid_angle_cosine";
  throw Error(ErrorKind::unexpected,
              "method '" + method + "' is not one of solid-angle, solid-angle-exact, solid-angle-cosine, crown-shells");
}

}  // namespace

SolidAnglePass::SolidAnglePass(Device& device, const std::string& method, FarFieldError error, int lanes)
    : device_(&device),
      method_(method),
      error_(error),
      lanes_(device, lanes, method),
      list_(device, "tile_spheres", "list_tile_spheres", method,
            Lanes(device, 16).option() + " " + share_option(method)),
      shade_(device, "solid_angle", "shade_by_spheres", method, lanes_.option() + " " + share_option(method)) {}

void SolidAnglePass::fit_tables(std::size_t tiles, std::size_t entries) {
  if (tiles_.size() < tiles) tiles_ = Buffer<TileOcclusion>(*device_, tiles, "tile occlusion");
  if (lists_.size() < entries) lists_ = Buffer<std::array<std::uint32_t, 2>>(*device_, entries, "sphere lists");
}

void SolidAnglePass::run(const FragmentPlanes& planes, const OwnerTables& owners, const Buffer<ShadingSphere>& spheres,
                         std::size_t sphere_count, Buffer<float>& visibility) {
  require_planes(method_.c_str(), planes, visibility);
  require_some(method_.c_str(), "spheres", spheres.size());
  if (sphere_count > spheres.size())
    throw Error(ErrorKind::unexpected, method_ + ": " + std::to_string(sphere_count) +
                                           " spheres asked for, the buffer holds " + std::to_string(spheres.size()));
  const auto count = static_cast<std::uint32_t>(sphere_count);
  const auto row_length = static_cast<std::uint32_t>(std::max<std::size_t>(planes.row_length, UNIT));
  const auto units = static_cast<std::uint32_t>(planes.padded_fragments / UNIT);
  const std::uint32_t tiles = tiles_of_units(units, row_length);
  // Spheres are sorted UNIT at a time.
  const auto slots = static_cast<std::uint32_t>(std::min(sphere_count, longest_list) + UNIT);
  fit_tables(tiles, static_cast<std::size_t>(tiles) * LISTS * slots);

  list_.launch(tiles, 1, planes.position_x, planes.position_y, planes.position_z, planes.owner, planes.validity,
               owners.group, owners.rows(), spheres, count, error_.each, error_.total, row_length, units, tiles, tiles_,
               lists_, slots);
  const std::uint32_t items = lanes_.items(planes);
  shade_.launch(items, lanes_.local_size(), planes.position_x, planes.position_y, planes.position_z, planes.normal_x,
                planes.normal_y, planes.normal_z, planes.owner, owners.group, owners.rows(), spheres, count, tiles_,
                lists_, slots, row_length, items, visibility, planes.validity);
}

}  // namespace understory
