// The share of a fragment's sky that a sphere blocks, in double and by quadrature: rings of constant angle to the
// normal, each blocked over a width in azimuth. Shares nothing with the kernels' closed forms but the geometry.
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <numbers>

namespace understory::reference {

/// Integral over [from, to] of an integrand with square-root ends: midpoints in the angle of a cosine substitution.
inline double integrate(double from, double to, const std::function<double(double)>& f) {
  constexpr int nodes = 4000;
  double sum = 0;
  for (int i = 0; i < nodes; ++i) {
    const double turn = std::numbers::pi * (i + 0.5) / nodes;
    sum += f((from + to) / 2 - (to - from) / 2 * std::cos(turn)) * std::sin(turn);
  }
  return sum * (to - from) / 2 * std::numbers::pi / nodes;
}

/// Integral of `weight(theta)` over the directions of a cap of half-angle `radius` around angle `tilt` from the normal,
/// above the tangent plane. Angles in rad.
inline double over_clipped_cap(double tilt, double radius, const std::function<double(double)>& weight) {
  const double pi = std::numbers::pi, horizon = pi / 2;
  const auto ring = [&](double theta) {
    const double cosine = (std::cos(radius) - std::cos(theta) * std::cos(tilt)) / (std::sin(theta) * std::sin(tilt));
    return 2 * std::acos(std::clamp(cosine, -1.0, 1.0)) * std::sin(theta) * weight(theta);
  };
  double total = 0;
  if (radius > tilt)
    total += integrate(0, std::min(radius - tilt, horizon),
                       [&](double theta) { return 2 * pi * std::sin(theta) * weight(theta); });
  const double from = std::abs(tilt - radius), to = std::min(tilt + radius, horizon);
  return from < to ? total + integrate(from, to, ring) : total;
}

enum class Weighting { uniform, cosine };

/// `c`: the sphere's centre from the fragment; `n`: unit normal. Within the sphere the share goes linearly from its
/// limit at the surface to 1 at the centre.
inline double blocked_share(glm::dvec3 c, glm::dvec3 n, double radius, Weighting weighting) {
  const double pi = std::numbers::pi, distance = glm::length(c);
  if (distance == 0) return 1;
  const double tilt = std::acos(std::clamp(glm::dot(c, n) / distance, -1.0, 1.0));
  const double cone = std::asin(std::min(radius / distance, 1.0));
  const double share = weighting == Weighting::cosine
                           ? over_clipped_cap(tilt, cone, [](double theta) { return std::cos(theta); }) / pi
                           : over_clipped_cap(tilt, cone, [](double) { return 1.0; }) / (2 * pi);
  return distance < radius ? 1 - (1 - share) * distance / radius : share;
}

/// Eq. 7-8 of Hegeman et al. 2006: pi (r/d)^2 of 2 pi, capped at all.
inline double paper_share(glm::dvec3 c, double radius) { return std::min(radius * radius / (2 * glm::dot(c, c)), 1.0); }

}  // namespace understory::reference
