// The mean transmittance of an even crown by brute quadrature: directions on equal shares of the cosine-weighted
// hemisphere, each with the way through the shell from its two crossings.
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

namespace understory::reference {

/// Length of the ray from `p` along `w` within the ellipsoid about the origin; `radii` along x, y, z.
inline double chord(glm::dvec3 p, glm::dvec3 w, glm::dvec3 radii) {
  const glm::dvec3 u = p / radii, v = w / radii;
  // Foot of the perpendicular from the centre, in the frame of the unit sphere.
  const double speed = glm::length(v), foot = -glm::dot(u, v) / (speed * speed);
  const glm::dvec3 nearest = u + foot * v;
  const double off = glm::length(nearest);
  if (off >= 1) return 0;
  const double half = std::sqrt((1 - off) * (1 + off)) / speed;
  return std::max(foot + half, 0.0) - std::max(foot - half, 0.0);
}

/// V_c; `side`^2 directions.
inline double crown_transmittance(glm::dvec3 p, glm::dvec3 n, glm::dvec3 radii, double k, bool dome, int side = 200) {
  const glm::dvec3 helper = std::abs(n.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 a = glm::normalize(glm::cross(helper, n)), b = glm::cross(n, a);
  double sum = 0;
  for (int i = 0; i < side; ++i) {
    const double square = (i + 0.5) / side, flat = std::sqrt(square), height = std::sqrt(1 - square);
    for (int j = 0; j < side; ++j) {
      const double turn = 2 * std::numbers::pi * (j + 0.5 * (i % 2) + 0.25) / side;
      const glm::dvec3 w = flat * (std::cos(turn) * a + std::sin(turn) * b) + height * n;
      if (!dome || w.z > 0) sum += std::exp(-k * chord(p, w, radii));
    }
  }
  return sum / (side * side);
}

}  // namespace understory::reference
