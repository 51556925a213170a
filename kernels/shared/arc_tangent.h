// atan(y / x) for y, x >= 0 without a library call: an odd minimax polynomial in the smaller over the larger number.
// Error below 5e-7 rad over the whole quadrant (tests/kernels/exp_minus_test.cpp); 0 where both are 0.
#ifndef UNDERSTORY_ARC_TANGENT_H
#define UNDERSTORY_ARC_TANGENT_H

#include "kernels/shared/limits.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

/// The angle, in [0, pi/2], between the x axis and (x, y). Ratios below 1e-30 count as 0.
SHARED real arc_tangent(real y, real x) {
  const truth steep = y > x;
  const real small = PICK(steep, x, y), large = PICK(steep, y, x);
  const real ratio = small / at_least(large, REAL(1e-30));
  const real square = ratio * ratio;
  real p = REAL(0.0068117856);
  p = fma(p, square, REAL(-0.0336041978));
  p = fma(p, square, REAL(0.0796236467));
  p = fma(p, square, REAL(-0.1323334073));
  p = fma(p, square, REAL(0.1980781522));
  p = fma(p, square, REAL(-0.3331736802));
  p = fma(p, square, REAL(0.9999961116));
  const real angle = p * ratio;
  return PICK(steep, REAL(1.5707963267948966) - angle, angle);
}

#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
