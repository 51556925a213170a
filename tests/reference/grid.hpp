// The grid methods in double: trilinear look-up by sim/occlusion_grid.hpp, cones clipped by one-dimensional quadrature.
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/grid_bodies.hpp"

namespace understory::reference {

/// (1/pi) integral of the cosine over the part above the plane of a cone whose axis is at the angle b to the normal. On
/// each ring of equal height about the normal the cone covers an arc.
inline double clipped_cosine(double aperture, double b, int rings = 4000) {
  const double q = 1 - 2 * aperture;
  double sum = 0;
  for (int i = 0; i < rings; ++i) {
    // Rings of equal cosine-weighted area.
    const double z = std::sqrt((i + 0.5) / rings), flat = std::sqrt(1 - z * z) * std::sin(b);
    const double level = q - z * std::cos(b);
    sum += flat <= std::abs(level) ? (level < 0 ? 1.0 : 0.0) : std::acos(level / flat) / std::numbers::pi;
  }
  return sum / rings;
}

inline OccludedDirections look_up(const GridBody& body, const TestFragment& f, bool cone) {
  const OcclusionGrid stored = unpacked(body.grid, cone ? packed_cone(body.grid) : packed_share(body.grid));
  return occluded_at(stored, glm::transpose(body.rotation) * (glm::dvec3(f.position) - body.position));
}

/// What one body takes from a fragment of a scalar grid.
inline double grid_blocked(const GridBody& body, const TestFragment& f, bool own, double self_share) {
  const double share = double(look_up(body, f, false).share);
  if (share == 0 && !own) return 0;
  if (!own) return std::min(2 * share, 1.0);
  const double border = double(body.grid.border), traced = share * (1 - border) + border;
  return self_share * std::clamp(2 * traced - 1, 0.0, 1.0);
}

/// What one body takes from a fragment of its own, by sim/own_shadow.hpp.
inline double own_blocked(const GridBody& body, const TestFragment& f) {
  if (body.own.size == 0) return 0;
  const glm::dmat3 to_body = glm::transpose(body.rotation);
  return double(own_share(unpacked(body.own, packed_own_shadow(body.own)),
                          to_body * (glm::dvec3(f.position) - body.position), to_body * glm::dvec3(f.normal)));
}

/// Whether the body's grid holds a fragment.
inline bool holds(const GridBody& body, const TestFragment& f) {
  const glm::dvec3 p = glm::transpose(body.rotation) * (glm::dvec3(f.position) - body.position);
  return glm::all(glm::lessThanEqual(glm::dvec3(body.grid.low), p)) &&
         glm::all(glm::lessThanEqual(p, glm::dvec3(body.grid.high)));
}

/// What one body takes from a fragment by its clipped cone. `paper`: an opaque one.
inline double cone_blocked(const GridBody& body, const TestFragment& f, bool paper) {
  const OccludedDirections o = look_up(body, f, true);
  const glm::dvec3 mean = body.rotation * glm::dvec3(o.direction);
  const double share = double(o.share), length = glm::length(mean);
  if (share < 1e-9) return 0;
  const double aperture = paper ? share : std::clamp(1 - length / share, share, 1.0);
  const glm::dvec3 axis = length < 1e-9 ? glm::dvec3(0) : mean / length;  // of all directions or none: any
  const double angle = std::acos(std::clamp(glm::dot(axis, glm::dvec3(f.normal)), -1.0, 1.0));
  return share / aperture * clipped_cosine(aperture, angle);
}

}  // namespace understory::reference
