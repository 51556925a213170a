// Mesh pose in double precision, with the library's own sine and cosine: what the kernel `pose_mesh` must give.
#pragma once
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "kernels/shared/records.h"
#include "sim/pose.hpp"

namespace understory::reference {

/// A rest point (m, prototype frame) with its flutter vector (raw, -127..127) and phase (1/256 turn), posed as
/// kernels/shared/records.h says: camera-relative metres.
inline glm::dvec3 posed_point(const LimbPose& limb, glm::dvec3 rest, glm::dvec3 flutter = glm::dvec3(0),
                              double flutter_phase = 0) {
  const auto transformed = [](const float* rows, glm::dvec3 p) {
    glm::dvec3 result;
    for (int row = 0; row < 3; ++row)
      result[row] = rows[4 * row] * p.x + rows[4 * row + 1] * p.y + rows[4 * row + 2] * p.z + rows[4 * row + 3];
    return result;
  };
  const double swing = std::sin(2 * std::numbers::pi * flutter_phase / 256 + double(limb.flutter_phase));
  const glm::dvec3 p = transformed(limb.to_limb, rest + flutter * (double(limb.flutter_amplitude) * swing));
  const double f = double(limb.curvature) * p.x;
  if (f == 0) return transformed(limb.to_scene, p);
  const double along = p.x * std::sin(f) / f, sideways = p.x * 2 * std::sin(f / 2) * std::sin(f / 2) / f;
  return transformed(limb.to_scene, {along - p.y * std::sin(f), sideways + p.y * std::cos(f), p.z});
}

/// Vertex `vertex` of a prototype's blocks, posed as part of an instance whose limbs start at `first_limb` of the pose.
inline glm::dvec3 posed_vertex(const Prototype& prototype, const Pose& pose, std::uint32_t first_limb,
                               std::size_t vertex, bool with_flutter = true) {
  const VertexBlocks& v = prototype.vertices;
  const LimbPose& limb = pose.limbs[first_limb + v.block_limb[vertex / vertex_block]];
  const glm::dvec3 flutter(v.flutter_x[vertex], v.flutter_y[vertex], v.flutter_z[vertex]);
  return posed_point(limb, {v.x[vertex], v.y[vertex], v.z[vertex]}, with_flutter ? flutter : glm::dvec3(0),
                     v.flutter_phase[vertex]);
}

}  // namespace understory::reference
