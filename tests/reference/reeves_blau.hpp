// Ambient light by depth in the crown (Reeves and Blau 1985) in double.
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace understory::reference {

/// `p`: fragment from the sphere's centre, m; `ambient`: A; `extinction`: a, 1/m.
inline double reeves_blau(glm::dvec3 p, double radius, double ambient, double extinction) {
  return std::clamp(ambient * std::exp(-extinction * std::max(radius - glm::length(p), 0.0)), 0.0, 1.0);
}

}  // namespace understory::reference
