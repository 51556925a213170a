#include "sim/limb_pose.hpp"

#include <algorithm>
#include <cmath>

namespace understory {
namespace {

glm::dvec3 any_perpendicular(const glm::dvec3& axis) {
  const glm::dvec3 other = std::abs(axis.z) < 0.7 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  return glm::normalize(glm::cross(axis, other));
}

/// Turns (s, d) in the plane of the bend from s towards d.
glm::dmat3 turn_in_plane(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {{c, s, 0}, {-s, c, 0}, {0, 0, 1}};
}

/// (s, d, n) on the arc; the formula of kernels/shared/records.h.
glm::dvec3 on_arc(const glm::dvec3& p, double curvature) {
  const double f = curvature * p.x;
  const double sinc = std::abs(f) < 1e-4 ? 1 - f * f / 6 : std::sin(f) / f;
  const double rise = std::abs(f) < 1e-4 ? f / 2 : (1 - std::cos(f)) / f;
  return {p.x * sinc - p.y * std::sin(f), p.x * rise + p.y * std::cos(f), p.z};
}

void store_row(float* row, const glm::dvec3& factors, double constant) {
  for (int i = 0; i < 3; ++i) row[i] = static_cast<float>(factors[i]);
  row[3] = static_cast<float>(constant);
}

}  // namespace

LimbFrame BentLimb::frame_at(const glm::dvec3& rest) const {
  const glm::dvec3 local = glm::transpose(axes) * (rest - base);
  const glm::dvec3 hinged = turn_in_plane(hinge) * on_arc(local, curvature);
  return {frame.rotation * axes * turn_in_plane(hinge + curvature * local.x) * glm::transpose(axes),
          frame.base + scale * (frame.rotation * (axes * hinged))};
}

glm::dvec3 BentLimb::carried(const glm::dvec3& rest, double along) const {
  const glm::dvec3 joint = base + axes[0] * along;
  const LimbFrame there = frame_at(joint);
  return there.base + scale * (there.rotation * (rest - joint));
}

LimbPose BentLimb::record(const glm::dvec3& eye) const {
  LimbPose pose{};
  const glm::dmat3 to_world = scale * (frame.rotation * axes * turn_in_plane(hinge));
  const glm::dvec3 translation = frame.base - eye;
  for (int row = 0; row < 3; ++row) {
    store_row(pose.to_limb + 4 * row, axes[row], -glm::dot(axes[row], base));
    store_row(pose.to_scene + 4 * row, {to_world[0][row], to_world[1][row], to_world[2][row]}, translation[row]);
  }
  pose.curvature = static_cast<float>(curvature);
  return pose;
}

BentLimb bend_limb(const Limb& limb, const LimbFrame& frame, double scale, const glm::dvec3& sway) {
  const glm::dvec3 axis = glm::normalize(glm::dvec3(limb.axis));
  // In prototype axes: the part of the sway across the axis.
  glm::dvec3 bend = glm::transpose(frame.rotation) * sway;
  bend -= glm::dot(bend, axis) * axis;
  const double wanted = glm::length(bend);
  const glm::dvec3 direction = wanted > 1e-12 ? bend / wanted : any_perpendicular(axis);
  const double angle = largest_limb_angle * std::tanh(wanted / largest_limb_angle);

  BentLimb bent;
  bent.axes = {axis, direction, glm::cross(axis, direction)};
  bent.base = glm::dvec3(limb.base);
  bent.frame = frame;
  bent.scale = scale;
  const double length = std::max(double(limb.length), 1e-6), reach = std::max(double(limb.reach), 1e-6);
  bent.curvature = std::min({angle / length, largest_stretch / reach, largest_arc / length});
  bent.hinge = angle - bent.curvature * length;
  return bent;
}

}  // namespace understory
