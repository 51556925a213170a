// Eq. 4-6 of Hegeman et al. 2006 in double, in another form than the kernels': the cap's volume as a sum of discs, f as
// the squared cosine of an angle, the library's exponential.
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

namespace understory::reference {

/// Volume of the part of a sphere beyond a plane: `height` of the cap in [0, 2 radius]. Simpson's rule is exact here.
inline double cap_volume(double height, double radius) {
  const auto disc = [&](double t) { return std::numbers::pi * (radius * radius - (radius - t) * (radius - t)); };
  return height / 6 * (disc(0) + 4 * disc(height / 2) + disc(height));
}

/// f Vcap. `p`: fragment from the sphere's centre; `n`: unit normal.
inline double cap_occluders(glm::dvec3 p, glm::dvec3 n, double radius) {
  const double s = glm::dot(p, n);
  const double height = std::clamp(radius - s, 0.0, 2 * radius);
  const double off_axis = glm::length(glm::cross(p, n));
  const double cosine = std::cos(std::atan2(off_axis, height));
  return cosine * cosine * cap_volume(height, radius);
}

inline double sphere_cap(glm::dvec3 p, glm::dvec3 n, double radius, double alpha_rho) {
  return std::exp(-alpha_rho * cap_occluders(p, n, radius));
}

}  // namespace understory::reference
