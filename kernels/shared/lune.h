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

/// 1 - acos(c)/pi for c in [-1, 1]: error below 3e-5 (Abramowitz and Stegun 1964, 4.4.45, over pi).
SHARED real lune_width(real c) {
  const real x = at_most(fabs(c), REAL(1.0));
  real p = REAL(-0.00596238);
  p = fma(p, x, REAL(0.02363782));
  p = fma(p, x, REAL(-0.06751763));
  p = fma(p, x, REAL(0.49999525));
  const real angle = p * sqrt(at_least(REAL(1.0) - x, REAL(0.0)));  // acos(x)/pi
  return PICK(c < REAL(0.0), angle, REAL(1.0) - angle);
}

/// M_1 . g. `along`: n.g; `rise`: g.z; `c`: n.z
SHARED real lune_first(real along, real rise, real c) {
  const real sine = sqrt(at_least(fma(-c, c, REAL(1.0)), REAL(0.0)));
  return REAL(0.6666666666666666) * fma(lune_width(c), along, REAL(0.3183098861837907) * sine * rise);
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
