// Compiled with -O3 -march=native -ffast-math: what a compiler makes of the formula when it may do as it likes.
#include "bench/plain_loops.hpp"

#include <algorithm>
#include <cmath>

namespace understory {

void plain_sphere_cap(const PlainFragments& f, const std::int32_t* owner_crown, const CrownRecord* crowns,
                      float* visibility, std::size_t begin, std::size_t end) {
#pragma GCC ivdep
  for (std::size_t i = begin; i < end; ++i) {
    const std::int32_t row = owner_crown[f.owner[i]];
    const CrownRecord& crown = crowns[std::max(row, 0)];
    const float x = f.position_x[i] - crown.x, y = f.position_y[i] - crown.y, z = f.position_z[i] - crown.z;
    const float a = f.normal_x[i], b = f.normal_y[i], c = f.normal_z[i], radius = crown.radius;
    const float s = x * a + y * b + z * c;
    const float h = std::clamp(radius - s, 0.0f, 2 * radius), square = h * h;
    const float ox = x - s * a, oy = y - s * b, oz = z - s * c;
    const float share = square / std::max(square + ox * ox + oy * oy + oz * oz, 1e-30f);
    const float v = std::exp(-crown.alpha_rho * 1.04719755f * share * square * (3 * radius - h));
    visibility[i] = row < 0 ? 1.0f : v;
  }
}

void plain_grass_height(const PlainFragments& f, const std::uint32_t* owner_class, std::uint32_t blade_class,
                        float* visibility, std::size_t begin, std::size_t end) {
#pragma GCC ivdep
  for (std::size_t i = begin; i < end; ++i) {
    const float share = f.height[i] / std::max(f.blade_length[i], 1e-30f);
    const bool blade = owner_class[f.owner[i]] == blade_class && f.blade_length[i] > 0;
    visibility[i] = blade ? std::clamp(share, 0.0f, 1.0f) : 1.0f;
  }
}

}  // namespace understory
