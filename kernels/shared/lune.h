// The directions that a surface of normal n under an open dome sees: the hemisphere of n above the horizon, a lune.
// Cosine-weighted moments M_j = (1/pi) integral of (n.w) w^j dw over it, t the angle between n and up (z):
//   M_0 = (1 + cos t)/2                                       (shared/open_dome.h)
//   M_1 = 2/3 [(1 - t/pi) n + (sin t/pi) z]
//   M_2 = 1/8 [(1 + cos t) I + n n + n z + z n - cos t z z]
// from w = (sqrt(1 - y^2) sin a, y, sqrt(1 - y^2) cos a) with y along the lune's edge and a in [t - pi/2, pi/2].
#ifndef UNDERSTORY_LUNE_H
#define UNDERSTORY_LUNE_H

#include "kernels/shared/limits.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

/// M_1 . g. `along`: n.g; `rise`: g.z; `c`: n.z in [-1, 1]. Both the angle and its sine are sqrt(1 - |c|) times a
/// smooth function of |c|: acos(x)/pi within 3e-5 (Abramowitz and Stegun 1964, 4.4.45, over pi), sqrt(1 - x^2)/pi
/// within 2e-6 (least largest error).
SHARED real lune_first(real along, real rise, real c) {
  const real x = at_most(fabs(c), REAL(1.0)), root = sqrt(REAL(1.0) - x);
  real p = REAL(-0.00596238);
  p = fma(p, x, REAL(0.02363782));
  p = fma(p, x, REAL(-0.06751763));
  p = fma(p, x, REAL(0.49999525));
  const real angle = p * root, width = PICK(c < REAL(0.0), angle, REAL(1.0) - angle);  // 1 - acos(c)/pi
  real q = REAL(-0.00374936);
  q = fma(q, x, REAL(0.01507597));
  q = fma(q, x, REAL(-0.03853528));
  q = fma(q, x, REAL(0.15903647));
  q = fma(q, x, REAL(0.31831166));
  return REAL(0.6666666666666666) * fma(width, along, q * root * rise);
}

/// g . M_2 g. `square`: g.g
SHARED real lune_second(real along, real rise, real square, real c) {
  const real mixed = fma(along, fma(REAL(2.0), rise, along), -c * rise * rise);
  return REAL(0.125) * fma(REAL(1.0) + c, square, mixed);
}

#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
