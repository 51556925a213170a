// Traces the occlusion grid of a rigid body, Malmer et al. 2005 sections 3 and 5: trace, fill the inside, open the
// border.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "sim/occlusion_grid.hpp"

namespace understory {

struct GridSettings {
  GridSize size{32, 32, 32};
  double epsilon = 0.1;      // eq. 4: the share that may be neglected at the border
  double stretch = 0;        // of OcclusionGrid, [0, 8]
  std::uint32_t rays = 256;  // per sample
  std::uint64_t seed = 1;
  GridBorder border = GridBorder::fade;
  bool cone = true;  // with directions
};

/// `vertices`: m, frame of the body; `triangles`: three indices each, any winding: both sides block. Samples that lie
/// within a closed mesh see it all around and get what the nearest point of its surface sees, or else what their
/// neighbours do (fill_inside), but those whose neighbours lie within it too are marked (close_solid); an open or flat
/// mesh has none. Rays go to the body's bounding sphere only, so that far samples are as exact as near ones. The same
/// input gives the same bits for any thread count. Throws Error(invalid_input) for a mesh without triangles or of no
/// extent, vertices that are not finite, and settings out of range or whose memory would not fit.
OcclusionGrid bake_grid(std::span<const glm::vec3> vertices, std::span<const std::uint32_t> triangles,
                        const GridSettings& settings);

/// Throws Error(invalid_input) naming what is out of range and what is allowed.
void check_settings(const GridSettings& settings);

}  // namespace understory
