// Eq. 4-6 of Hegeman et al. 2006 in the nearest of several spheres, in double, by tests/reference/sphere_cap.hpp.
#pragma once
#include <algorithm>
#include <span>

#include "tests/reference/sphere_cap.hpp"

namespace understory::reference {

struct CapSphere {
  glm::dvec3 centre{0};
  double radius = 1, alpha_rho = 1;
};

/// `whole`: around the crown; `clusters`: may be empty. `levels`: the whole crown's visibility is a factor.
inline double shells_cap(glm::dvec3 p, glm::dvec3 n, const CapSphere& whole, std::span<const CapSphere> clusters,
                         bool levels) {
  const auto in = [&](const CapSphere& sphere) {
    return sphere_cap(p - sphere.centre, n, sphere.radius, sphere.alpha_rho);
  };
  if (clusters.empty()) return in(whole);
  const auto owner = std::min_element(clusters.begin(), clusters.end(), [&](const CapSphere& a, const CapSphere& b) {
    return glm::distance(p, a.centre) < glm::distance(p, b.centre);
  });
  return in(*owner) * (levels ? in(whole) : 1.0);
}

}  // namespace understory::reference
