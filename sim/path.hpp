// Smooth motion through keyframes: where a moving body is at time t, with continuous velocity and angular velocity.
#pragma once
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <vector>

#include "sim/scene.hpp"

namespace understory {

/// A rigid motion: x -> rotation * x + translation.
struct Transform {
  glm::dquat rotation{1, 0, 0, 0};  // unit (w, x, y, z)
  glm::dvec3 translation{0};        // m

  glm::dvec3 apply(const glm::dvec3& point) const { return rotation * point + translation; }
  /// First `inner`, then this.
  Transform operator*(const Transform& inner) const {
    return {rotation * inner.rotation, rotation * inner.translation + translation};
  }
};

/// Position and rotation of one keyframe; its angles turn about the fixed x, then y, then z axis.
Transform transform_of(const Keyframe& keyframe);

/// Passes through every keyframe, once differentiable everywhere. None: identity; one: fixed.
/// Without `loop` the body starts from rest at the first keyframe and comes to rest at the last, and stays there.
/// With `loop` the path is periodic: over last - first time if the last keyframe repeats the first's pose, else over
/// one more segment of mean duration that leads back. Between two keyframes it turns the shorter way, so a wheel wants
/// keyframes less than half a turn apart. Throws Error(invalid_input) when times do not increase.
Transform path_at(const std::vector<Keyframe>& keyframes, bool loop, double time);

/// Seconds from the first keyframe to the last, or of one turn of a loop; 0 for fewer than two keyframes.
double path_duration(const std::vector<Keyframe>& keyframes, bool loop);

}  // namespace understory
