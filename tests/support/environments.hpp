// Environment maps made by hand.
#pragma once
#include <cmath>
#include <numbers>

#include "sim/environment.hpp"

namespace understory {

/// `radiance_of(direction)` at the centre of every pixel; the map's middle looks along +x.
template <class RadianceOf>
EnvironmentMap made_environment(int height, const RadianceOf& radiance_of) {
  EnvironmentMap map{2 * height, height, {}};
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < map.width; ++column) {
      const double polar = std::numbers::pi * (row + 0.5) / height;
      const double azimuth = 2 * std::numbers::pi * (0.5 - (column + 0.5) / map.width);
      map.radiance.push_back(radiance_of(
          glm::dvec3(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar))));
    }
  return map;
}

inline EnvironmentMap constant_environment(glm::vec3 radiance, int height = 8) {
  return made_environment(height, [&](glm::dvec3) { return radiance; });
}

/// 1 in the cone about `axis` whose half-angle has this cosine, 0 elsewhere.
inline EnvironmentMap cap_environment(glm::dvec3 axis, double cosine, int height = 256) {
  return made_environment(height, [&](glm::dvec3 d) { return glm::vec3(glm::dot(d, axis) > cosine ? 1.0f : 0.0f); });
}

/// Smooth, of three colours, within (0, 1).
inline EnvironmentMap smooth_environment(int height = 64) {
  return made_environment(height, [](glm::dvec3 d) {
    return glm::vec3(0.5 + 0.4 * d.x * d.z, 0.5 + 0.3 * d.z - 0.1 * d.y, 0.4 + 0.3 * d.y * d.y);
  });
}

}  // namespace understory
