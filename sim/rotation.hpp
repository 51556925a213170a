// Rotations as vectors (axis times angle) and back, safe at zero angle; comparing poses.
#pragma once
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "sim/path.hpp"

namespace understory {

/// Axis times angle of the shorter way, radians in [0, pi]. `rotation` is unit.
inline glm::dvec3 rotation_vector(const glm::dquat& rotation) {
  const glm::dvec3 axis(rotation.x, rotation.y, rotation.z);
  const double sine = glm::length(axis);
  if (sine == 0) return glm::dvec3(0);
  const double sign = rotation.w < 0 ? -1 : 1;
  return axis * (sign * 2 * std::atan2(sine, std::abs(rotation.w)) / sine);
}

inline glm::dquat rotation_of(const glm::dvec3& vector) {
  const double angle = glm::length(vector);
  return angle > 0 ? glm::angleAxis(angle, vector / angle) : glm::dquat(1, 0, 0, 0);
}

/// Within a micrometre and a microradian.
inline bool same_pose(const Transform& a, const Transform& b) {
  return glm::distance(a.translation, b.translation) < 1e-6 &&
         glm::length(rotation_vector(glm::conjugate(a.rotation) * b.rotation)) < 1e-6;
}

}  // namespace understory
