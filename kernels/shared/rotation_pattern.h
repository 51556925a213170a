// The rotation of a sample set changes from pixel to pixel: 16 angles in the order of a 4 x 4 Bayer matrix, so that any
// 4 x 4 pixels hold all of them.
#ifndef UNDERSTORY_ROTATION_PATTERN_H
#define UNDERSTORY_ROTATION_PATTERN_H

#include "kernels/shared/real.h"

#ifdef __OPENCL_C_VERSION__
/// 0 to 15 for the pixel (x, y).
SHARED whole pattern_index(whole x, whole y) {
  const whole mixed = x ^ y;
  return (mixed & 1) << 3 | (y & 1) << 2 | (mixed & 2) | (y & 2) >> 1;
}
#endif

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

/// sin(2 pi t) for t in [-0.5, 0.5], within 4e-6: Taylor's series to the ninth power over a quarter turn.
SHARED real sine_of_turn(real t) {
  const real x = REAL(4.0) * t;
  const real q = PICK(x > REAL(1.0), REAL(2.0) - x, PICK(x < REAL(-1.0), REAL(-2.0) - x, x));
  const real s = q * q;
  real p = REAL(1.6044118e-4);
  p = fma(p, s, REAL(-4.6817541e-3));
  p = fma(p, s, REAL(7.9692626e-2));
  p = fma(p, s, REAL(-6.4596410e-1));
  p = fma(p, s, REAL(1.5707963));
  return p * q;
}

/// cos(2 pi t) for t in [-0.5, 0.5].
SHARED real cosine_of_turn(real t) { return sine_of_turn(REAL(0.25) - fabs(t)); }

#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
