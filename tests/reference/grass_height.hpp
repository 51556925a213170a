// The two factors of eq. 9 of Hegeman et al. 2006 in double; the tilt as cos^2 of half the angle between normal and up.
#pragma once
#include <algorithm>
#include <cmath>

namespace understory::reference {

inline double open_dome(double normal_z) {
  const double half_tilt = std::acos(std::clamp(normal_z, -1.0, 1.0)) / 2;
  return std::cos(half_tilt) * std::cos(half_tilt);
}

/// `height` above the root and `total` height of the grass, m; grass of no height covers nothing.
inline double grass_height(double height, double total) {
  return total > 0 ? std::clamp(height, 0.0, total) / total : 1.0;
}

}  // namespace understory::reference
