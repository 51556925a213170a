#include "host/passes/tile_grids.hpp"

#include <algorithm>
#include <glm/glm.hpp>
#include <limits>

#include "kernels/shared/fragment_tiles.h"

namespace understory {
namespace {

constexpr std::uint32_t longest_list = 256;  // grids per tile; a tile with more tries all of them
constexpr std::uint32_t group = 16;          // grids that the kernel tests at a time

/// The grid's box in camera-relative metres: low and high corner.
struct Bounds {
  glm::dvec3 low{0}, high{0};
};

Bounds bounds_of(const GridRecord& record) {
  const float* m = record.to_box;
  const glm::dmat3 to_box(glm::dvec3(m[0], m[4], m[8]), glm::dvec3(m[1], m[5], m[9]), glm::dvec3(m[2], m[6], m[10]));
  const glm::dmat3 to_scene = glm::inverse(to_box);
  const glm::dvec3 centre = -(to_scene * glm::dvec3(m[3], m[7], m[11]));
  glm::dvec3 reach = glm::abs(to_scene[0]) + glm::abs(to_scene[1]) + glm::abs(to_scene[2]);
  reach = reach * 1.0001 + 1e-4;
  return {centre - reach, centre + reach};
}

}  // namespace

GridTable::GridTable(Device& device, std::span<const std::uint8_t> samples)
    : device_(&device), samples_(device, samples, "occlusion grids") {}

void GridTable::place(const std::vector<GridRecord>& records) {
  count_ = static_cast<std::uint32_t>(records.size());
  padded_ = (std::max(count_, 1u) + group - 1) / group * group;
  // What pads the planes lies nowhere.
  std::vector<float> planes(std::size_t(6) * padded_, std::numeric_limits<float>::infinity());
  for (std::uint32_t i = 0; i < count_; ++i) {
    const Bounds bounds = bounds_of(records[i]);
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      planes[axis * padded_ + i] = static_cast<float>(bounds.low[static_cast<int>(axis)]);
      planes[(axis + 3) * padded_ + i] = static_cast<float>(bounds.high[static_cast<int>(axis)]);
    }
  }
  if (records_.size() < padded_) {
    records_ = Buffer<GridRecord>(*device_, padded_, "grid records");
    bounds_ = Buffer<float>(*device_, planes.size(), "grid bounds");
  }
  if (count_ > 0) records_.write(records);
  bounds_.write(planes);
}

TileGridsPass::TileGridsPass(Device& device, const std::string& pass)
    : device_(&device), kernel_(device, "tile_grids", "list_tile_grids", pass, "-DW=16") {}

void TileGridsPass::run(const FragmentPlanes& planes, const GridTable& grids) {
  const auto row_length = static_cast<std::uint32_t>(std::max<std::size_t>(planes.row_length, UNIT));
  const auto units = static_cast<std::uint32_t>(planes.padded_fragments / UNIT);
  const std::uint32_t tiles = tiles_of_units(units, row_length);
  capacity_ = std::clamp(grids.count(), 1u, longest_list);
  if (listed_.size() < tiles) listed_ = Buffer<std::uint32_t>(*device_, tiles, "tiles' numbers of grids");
  const std::size_t entries = std::size_t(tiles) * capacity_;
  if (lists_.size() < entries) lists_ = Buffer<std::uint32_t>(*device_, entries, "tiles' lists of grids");
  kernel_.launch(tiles, 1, planes.position_x, planes.position_y, planes.position_z, planes.validity, grids.records(),
                 grids.count(), grids.bounds(), grids.padded(), row_length, units, tiles, listed_, lists_, capacity_);
}

}  // namespace understory
