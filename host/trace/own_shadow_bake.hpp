// Traces what a rigid body takes from its own surface (sim/own_shadow.hpp).
#pragma once
#include <cstdint>
#include <span>

#include "sim/own_shadow.hpp"

namespace understory {

/// `vertices`: m, frame of the body; `triangles`: three indices each. Rays start from both sides of points that are
/// even by area; a side that sees the body all around lies within it and is left out. `rays`: per point and side,
/// about. A convex body has no shadow of its own: size 0. The same input gives the same bits for any thread count.
/// Throws Error(invalid_input) as bake_grid does for meshes.
OwnShadow bake_own_shadow(std::span<const glm::vec3> vertices, std::span<const std::uint32_t> triangles,
                          std::uint32_t rays, std::uint64_t seed);

/// bake_own_shadow, or what it gave before for the same input (bake_cache.hpp).
OwnShadow cached_own_shadow(std::span<const glm::vec3> vertices, std::span<const std::uint32_t> triangles,
                            std::uint32_t rays, std::uint64_t seed);

}  // namespace understory
