#include "host/passes/planes.hpp"

#include <string>

#include "kernels/shared/validity.h"
#include "sim/error.hpp"
#include "sim/frame.hpp"

namespace understory {
namespace {

// Kernels write the codes that frames hold.
static_assert(VALIDITY_BACKGROUND == validity::background && VALIDITY_NOT_FINITE == validity::not_finite &&
              VALIDITY_NOT_UNIT == validity::not_unit && VALIDITY_OUTSIDE_MODEL == validity::outside_model &&
              VALIDITY_OCCLUDER_TOO_CLOSE == validity::occluder_too_close &&
              VALIDITY_RADIUS_OUT_OF_RANGE == validity::radius_out_of_range &&
              VALIDITY_LEFT_IMAGE == validity::left_image && VALIDITY_GRID_BORDER == validity::grid_border);

template <typename T>
Buffer<T> filled(Device& device, std::size_t count, T value, const char* what) {
  return Buffer<T>(device, std::span<const T>(std::vector<T>(count, value)), what);
}

}  // namespace

FragmentPlanes allocate_planes(Device& device, std::size_t width, std::size_t height, bool grass) {
  FragmentPlanes planes;
  planes.fragments = width * height;
  planes.padded_fragments = padded_fragment_count(planes.fragments);
  planes.row_length = width;
  const std::size_t count = planes.padded_fragments;
  planes.position_x = filled(device, count, 0.0f, "position_x");
  planes.position_y = filled(device, count, 0.0f, "position_y");
  planes.position_z = filled(device, count, 0.0f, "position_z");
  planes.normal_x = filled(device, count, 0.0f, "normal_x");
  planes.normal_y = filled(device, count, 0.0f, "normal_y");
  planes.normal_z = filled(device, count, 0.0f, "normal_z");
  planes.depth = filled(device, count, 0.0f, "depth");
  planes.owner = filled<std::uint32_t>(device, count, 0, "owner");
  planes.validity = filled(device, count, validity::background, "validity");
  if (grass) {
    planes.height_above_root = filled(device, count, 0.0f, "height_above_root");
    planes.blade_length = filled(device, count, 0.0f, "blade_length");
  }
  return planes;
}

void allocate_rest_planes(Device& device, FragmentPlanes& planes) {
  for (auto* group : {&planes.rest_position, &planes.rest_normal})
    for (Buffer<float>& plane : *group) plane = filled(device, planes.padded_fragments, 0.0f, "rest point");
}

void allocate_texel_planes(Device& device, FragmentPlanes& planes) {
  planes.texel = filled(device, planes.padded_fragments, 0xffffffffu, "texel");
  planes.texel_place = filled(device, planes.padded_fragments, 0u, "texel place");
}

OwnerTables upload_owners(Device& device, std::span<const Owner> owners) {
  if (owners.empty()) throw Error(ErrorKind::unexpected, "owner table: 0 rows, at least the background is needed");
  std::vector<std::int32_t> crown, group;
  std::vector<std::uint32_t> surface_class;
  for (const Owner& owner : owners) {
    crown.push_back(owner.crown);
    group.push_back(owner.group);
    surface_class.push_back(static_cast<std::uint32_t>(owner.surface));
  }
  OwnerTables tables;
  tables.crown = Buffer<std::int32_t>(device, std::span<const std::int32_t>(crown), "owner crowns");
  tables.group = Buffer<std::int32_t>(device, std::span<const std::int32_t>(group), "owner groups");
  tables.surface_class = Buffer<std::uint32_t>(device, std::span<const std::uint32_t>(surface_class), "owner classes");
  return tables;
}

void require_size(const char* pass, const char* plane, std::size_t size, std::size_t expected) {
  if (size == expected) return;
  throw Error(ErrorKind::unexpected, std::string(pass) + ": plane " + plane + " has " + std::to_string(size) +
                                         " elements, " + std::to_string(expected) + " are needed");
}

void require_some(const char* pass, const char* table, std::size_t size) {
  if (size == 0) throw Error(ErrorKind::unexpected, std::string(pass) + ": table " + table + " is empty");
}

void require_planes(const char* pass, const FragmentPlanes& planes, const Buffer<float>& out) {
  const std::size_t expected = planes.padded_fragments;
  if (expected != padded_fragment_count(planes.fragments))
    throw Error(ErrorKind::unexpected, std::string(pass) + ": " + std::to_string(planes.fragments) +
                                           " fragments are padded to " + std::to_string(expected) + ", not to " +
                                           std::to_string(padded_fragment_count(planes.fragments)));
  require_size(pass, "position_x", planes.position_x.size(), expected);
  require_size(pass, "position_y", planes.position_y.size(), expected);
  require_size(pass, "position_z", planes.position_z.size(), expected);
  require_size(pass, "normal_x", planes.normal_x.size(), expected);
  require_size(pass, "normal_y", planes.normal_y.size(), expected);
  require_size(pass, "normal_z", planes.normal_z.size(), expected);
  require_size(pass, "owner", planes.owner.size(), expected);
  require_size(pass, "validity", planes.validity.size(), expected);
  require_size(pass, "out", out.size(), expected);
}

}  // namespace understory
