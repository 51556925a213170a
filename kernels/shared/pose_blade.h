// One blade of grass as a strip of 7 points: pairs at shares 0, 0.4, 0.75 of its length, and the tip. Its midline is a
// circular arc that keeps its length whatever the wind does; it bends by the bend vector (tip angle times direction).
#ifndef UNDERSTORY_POSE_BLADE_H
#define UNDERSTORY_POSE_BLADE_H

#include "kernels/shared/arc.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

typedef struct {
  real x, y, z;  // m, relative to the blade's root
} BladePoint;

/// The midline at `share` of the blade's length [0, 1]. `bend_x`, `bend_y`: radians, |bend| <= 2.5.
SHARED BladePoint blade_midline(real length, real bend_x, real bend_y, real share) {
  const real angle_squared = fma(bend_x, bend_x, bend_y * bend_y) * (share * share);
  const real arc = length * share;
  // Sideways (1 - cos f) / f along the bend, up sin(f) / f, f the angle reached here.
  const real sideways = arc * share * arc_versine(angle_squared);
  BladePoint point;
  point.x = bend_x * sideways;
  point.y = bend_y * sideways;
  point.z = arc * arc_sine(angle_squared);
  return point;
}

#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
