// Bodies with occlusion grids: where they stand, and their tables on the device. No test framework
// (test_fragments.hpp).
#pragma once
#include <glm/gtc/quaternion.hpp>
#include <vector>

#include "host/passes/tile_grids.hpp"
#include "sim/occlusion_grid.hpp"
#include "sim/own_shadow.hpp"
#include "tests/support/test_fragments.hpp"

namespace understory {

struct GridBody {
  OcclusionGrid grid;
  OwnShadow own;  // of size 0: it has none
  glm::dmat3 rotation{1};
  glm::dvec3 position{0};
  std::int32_t group = -1;

  GridRecord record(std::uint32_t first, std::uint32_t first_own = 0) const {
    GridRecord r{};
    const glm::dmat3 to_body = glm::transpose(rotation);
    for (int row = 0; row < 3; ++row) {
      const double scale = 2 / double(grid.high[row] - grid.low[row]);
      double constant = -0.5 * double(grid.low[row] + grid.high[row]);
      for (int axis = 0; axis < 3; ++axis) {
        r.to_box[4 * row + axis] = static_cast<float>(scale * to_body[axis][row]);
        r.axes[4 * row + axis] = static_cast<float>(rotation[axis][row]);
        constant -= to_body[axis][row] * position[axis];
      }
      r.to_box[4 * row + 3] = static_cast<float>(scale * constant);
    }
    r.first = first;
    r.width = grid.size[0];
    r.height = grid.size[1];
    r.depth = grid.size[2];
    r.group = group;
    r.border = grid.border;
    r.stretch = grid.stretch;
    r.faded_from = faded_from(grid);
    r.own_first = first_own;
    r.own_size = own.size;
    for (int axis = 0; own.size > 0 && axis < 3; ++axis)
      r.own_scale[axis] = (grid.high[axis] - grid.low[axis]) / (own.high[axis] - own.low[axis]);
    return r;
  }
};

/// Every body has samples of its own.
inline GridTable upload_grids(Device& device, const std::vector<GridBody>& bodies, bool cone) {
  std::vector<std::uint8_t> samples;
  std::vector<GridRecord> records;
  for (const GridBody& body : bodies) {
    const std::size_t first = samples.size() / (cone ? 4 : 1);
    const std::vector<std::uint8_t> packed = cone ? packed_cone(body.grid) : packed_share(body.grid);
    samples.insert(samples.end(), packed.begin(), packed.end());
    records.push_back(body.record(static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(samples.size() / 4)));
    if (!cone) continue;
    const std::vector<std::uint8_t> own = packed_own_shadow(body.own);
    samples.insert(samples.end(), own.begin(), own.end());
  }
  if (samples.empty()) samples.resize(8);
  GridTable table(device, samples);
  table.place(records);
  return table;
}

/// Owners: 0 background, 1 of no group, then one for each of `groups`.
inline OwnerTables body_owners(Device& device, std::size_t groups) {
  std::vector<Owner> owners(2 + groups);
  for (std::size_t group = 0; group < groups; ++group) owners[2 + group].group = static_cast<std::int32_t>(group);
  return upload_owners(device, owners);
}

}  // namespace understory
