// What a camera outside a plant sees of it: points on its surface, each with a rough count of the sky it sees.
#pragma once
#include <cstdint>
#include <vector>

#include "host/trace/rest_surface.hpp"

namespace understory {

struct SeenSample {
  SurfacePoint point;
  float visibility = 0;  // V_c by a few rays
};

/// Rays per point beside the one that decides whether it is seen.
inline constexpr int rays_per_seen_point = 3;

/// Spends about `rays` rays on points that are even by area, keeps those whose first ray gets out. In the order of the
/// triangles; the same for any number of threads.
std::vector<SeenSample> seen_samples(const RestSurface& surface, Sky sky, std::size_t rays, std::uint32_t seed);

}  // namespace understory
