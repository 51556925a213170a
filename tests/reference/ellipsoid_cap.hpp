// Eq. 4-6 on an ellipsoid in double: instead of transforming the normal, three points of the fragment's plane are
// scaled.
#pragma once
#include "tests/reference/sphere_cap.hpp"

namespace understory::reference {

/// `p`: fragment from the ellipsoid's centre, m; `axes`: columns are unit axes; `radii`: along them, m.
inline double ellipsoid_cap(glm::dvec3 p, glm::dvec3 n, const glm::dmat3& axes, glm::dvec3 radii, double alpha_rho) {
  const auto scaled = [&](glm::dvec3 v) { return (glm::transpose(axes) * v) / radii; };
  const glm::dvec3 helper = std::abs(n.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(n, helper)), v = glm::cross(n, u);
  glm::dvec3 normal = glm::normalize(glm::cross(scaled(p + u) - scaled(p), scaled(p + v) - scaled(p)));
  if (glm::dot(normal, scaled(p + n) - scaled(p)) < 0) normal = -normal;
  return std::exp(-alpha_rho * radii.x * radii.y * radii.z * cap_occluders(scaled(p), normal, 1));
}

}  // namespace understory::reference
