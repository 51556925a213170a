// The geometry of one bending limb: an arc of constant length that rides on its parent. Double precision.
#pragma once
#include <glm/glm.hpp>

#include "kernels/shared/records.h"
#include "sim/prototype.hpp"

namespace understory {

/// Where a limb would be if it did not bend itself: rest point p -> base + scale * rotation * (p - limb.base).
struct LimbFrame {
  glm::dmat3 rotation{1};  // prototype axes to world axes
  glm::dvec3 base{0};      // m, relative to the origin
};

/// No limb leans further from where its parent carries it, radians; approached smoothly (tanh).
inline constexpr double largest_limb_angle = 0.9;
/// Wood never stretches more than this on the outside of a bend: fresh wood breaks at about 1 % strain.
inline constexpr double largest_stretch = 0.008;
/// Angle of the arc, radians: an edge as long as the whole limb is then at most 0.4 % shorter as a chord (angle^2 /
/// 24).
inline constexpr double largest_arc = 0.3;

/// A limb in the wind. Point p is (s, d, n) = axes^T (p - base) in rest metres; an arc of `curvature` bends s towards
/// d, then all turns by `hinge` about n at the base: what the curvature may not give without stretching wood.
struct BentLimb {
  glm::dmat3 axes{1};    // columns: along the limb, direction of the bend, across; prototype axes
  glm::dvec3 base{0};    // rest, m
  double curvature = 0;  // 1/m
  double hinge = 0;      // radians
  LimbFrame frame;
  double scale = 1;

  /// Rotation that the wood around rest point p has undergone, and where p is.
  LimbFrame frame_at(const glm::dvec3& rest) const;
  /// Where p is when it is stiffly joined to the wood at `along` metres of the limb: how a crown rides on its trunk.
  glm::dvec3 carried(const glm::dvec3& rest, double along) const;
  /// Position relative to `eye`. Flutter is left at zero.
  LimbPose record(const glm::dvec3& eye) const;
};

/// `sway`: tip angle times its direction, world axes, radians. Only its part across the limb's present axis bends it.
BentLimb bend_limb(const Limb& limb, const LimbFrame& frame, double scale, const glm::dvec3& sway);

}  // namespace understory
