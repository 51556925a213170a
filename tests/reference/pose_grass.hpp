// A blade of grass in double, the other way round: instead of the arc's closed form, its tangent is integrated along
// the blade. What the kernel `pose_grass` must give.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>

namespace understory::reference {

/// Where the midline is at `share` [0, 1] of its length (m), relative to the root. The tangent starts upright and leans
/// towards `bend` (radians, tip angle times horizontal direction) in proportion to the way along. Simpson's rule.
inline glm::dvec3 blade_midline(double length, glm::dvec2 bend, double share) {
  const double angle = glm::length(bend);
  const glm::dvec2 direction = angle > 0 ? bend / angle : glm::dvec2(0);
  const auto tangent = [&](double u) { return glm::dvec3(std::sin(angle * u) * direction, std::cos(angle * u)); };
  constexpr int steps = 64;
  const double step = share / steps;
  glm::dvec3 sum = tangent(0) + tangent(share);
  for (int i = 1; i < steps; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * tangent(i * step);
  return length * step / 3 * sum;
}

/// The 7 vertices of a blade, m. `root` as wanted for the result; `facing`: azimuth of the width, radians; bends beyond
/// 2.5 rad are cut to that (kernels/shared/arc.h).
inline std::array<glm::dvec3, 7> posed_blade(glm::dvec3 root, double length, double half_width, double facing,
                                             glm::dvec2 bend) {
  bend *= 2.5 / std::max(glm::length(bend), 2.5);
  const glm::dvec3 width = half_width * glm::dvec3(std::cos(facing), std::sin(facing), 0);
  const glm::dvec3 middle = root + blade_midline(length, bend, 0.4), upper = root + blade_midline(length, bend, 0.75);
  return {root - width,
          root + width,
          middle - 0.85 * width,
          middle + 0.85 * width,
          upper - 0.5 * width,
          upper + 0.5 * width,
          root + blade_midline(length, bend, 1)};
}

}  // namespace understory::reference
