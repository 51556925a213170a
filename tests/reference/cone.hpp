// Cones of directions by quadrature: what a cone, or two, block above a plane.
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

namespace understory::reference {

/// What lies in a region of directions above the plane of `n`.
struct DirectionSums {
  double solid_angle = 0;   // share of the full sphere
  double cosine = 0;        // (1/pi) integral of n.direction
  glm::dvec3 direction{0};  // (1/4 pi) integral of the direction
};

/// Sums over the directions of the hemisphere of +z for which `inside` holds: rings of equal height, midpoint rule.
template <class Inside>
DirectionSums sum_above_plane(const Inside& inside, int rings = 1200) {
  DirectionSums sums;
  const int turns = 2 * rings;
  const double weight = 0.5 / (double(rings) * turns);
  for (int i = 0; i < rings; ++i) {
    const double z = (i + 0.5) / rings, flat = std::sqrt(1 - z * z);
    for (int j = 0; j < turns; ++j) {
      const double turn = 2 * std::numbers::pi * (j + 0.5) / turns;
      const glm::dvec3 w(flat * std::cos(turn), flat * std::sin(turn), z);
      if (!inside(w)) continue;
      sums.solid_angle += weight;
      sums.cosine += 4 * weight * z;
      sums.direction += weight * w;
    }
  }
  return sums;
}

/// A cone of half-angle h about (sin b, 0, cos b), above the plane of +z.
inline DirectionSums clipped_cone(double aperture, double b, int rings = 1200) {
  const glm::dvec3 axis(std::sin(b), 0, std::cos(b));
  const double cosine = 1 - 2 * aperture;
  return sum_above_plane([&](const glm::dvec3& w) { return glm::dot(w, axis) > cosine; }, rings);
}

/// Share of the full sphere that lies in both of two cones whose axes are at the angle b. The first is about +z: on
/// each ring the second covers an arc, so that one integral is left.
inline double overlap_of_cones(double first, double second, double b, int rings = 200000) {
  const double p = 1 - 2 * first, q = 1 - 2 * second;
  double sum = 0;
  for (int i = 0; i < rings; ++i) {
    const double z = p + (1 - p) * (i + 0.5) / rings, flat = std::sqrt(1 - z * z) * std::sin(b);
    const double level = q - z * std::cos(b);  // inside where flat cos(turn) > level
    sum += flat <= std::abs(level) ? (level < 0 ? 1.0 : 0.0) : std::acos(level / flat) / std::numbers::pi;
  }
  return sum / rings * (1 - p) / 2;
}

}  // namespace understory::reference
