// Baked grids kept between runs (bake_cache.hpp), found by the content of the mesh and the settings.
#pragma once
#include "host/trace/grid_bake.hpp"

namespace understory {

/// bake_grid, or what it gave before for the same vertices, triangles and settings.
OcclusionGrid cached_grid(std::span<const glm::vec3> vertices, std::span<const std::uint32_t> triangles,
                          const GridSettings& settings);

}  // namespace understory
