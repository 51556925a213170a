// A rest point on its limb at time t: into the limb's frame (s along the axis, d in the bend's direction, n across),
// along a circular arc whose axis keeps its length, and out into the scene. Matrices are 3x4, row-major.
#ifndef UNDERSTORY_POSE_LIMB_H
#define UNDERSTORY_POSE_LIMB_H

#include "kernels/shared/arc.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

#define ROW(m, r, x, y, z) \
  fma((real)(m[4 * r]), x, fma((real)(m[4 * r + 1]), y, fma((real)(m[4 * r + 2]), z, (real)(m[4 * r + 3]))))

SHARED void pose_on_limb(MATRIX to_limb, ELEMENT curvature, MATRIX to_scene, PRIVATE real* x, PRIVATE real* y,
                         PRIVATE real* z) {
  const real s = ROW(to_limb, 0, *x, *y, *z), d = ROW(to_limb, 1, *x, *y, *z), n = ROW(to_limb, 2, *x, *y, *z);
  const real f = (real)(curvature)*s, q = f * f;
  const real sine_by_f = arc_sine(q), versine_by_q = arc_versine(q);
  const real bent_s = fma(-d * f, sine_by_f, s * sine_by_f);                   // s sinc f - d sin f
  const real bent_d = fma(s * f, versine_by_q, fma(-d * q, versine_by_q, d));  // s (1 - cos f)/f + d cos f
  *x = ROW(to_scene, 0, bent_s, bent_d, n);
  *y = ROW(to_scene, 1, bent_s, bent_d, n);
  *z = ROW(to_scene, 2, bent_s, bent_d, n);
}

#undef ROW
#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
