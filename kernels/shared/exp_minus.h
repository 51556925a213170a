// exp(-x) for x >= 0 as a power of two times a polynomial: library exponentials are slow or scalar on CPU devices.
//   exp(-x) = 2^n 2^f,  n = round(-x log2 e),  |f| <= 1/2;  2^f by a minimax polynomial, relative error 9.2e-8.
// Absolute error below 2e-7 and relative error below 8e-6 for all x in [0, 87] (tests/kernels/exp_minus_test.cpp); the
// result of any x beyond, and of NaN, is that of 87: 1.6e-38.
#ifndef UNDERSTORY_EXP_MINUS_H
#define UNDERSTORY_EXP_MINUS_H

#include "kernels/shared/limits.h"
#include "kernels/shared/rounded.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

/// 2^n for whole n in [-126, 127].
SHARED real power_of_two(real n) {
#ifdef __OPENCL_C_VERSION__
  return AS_REAL((TO_WHOLE(n) + 127) << 23);
#else
  return std::exp2(n);
#endif
}

SHARED real exp_minus(real x) {
  const real t = at_most(x, REAL(87.0)) * REAL(-1.4426950408889634);
  const real n = rounded(t);
  const real f = t - n;
  real p = REAL(0.0013264727);
  p = fma(p, f, REAL(0.0096715128));
  p = fma(p, f, REAL(0.0555073374));
  p = fma(p, f, REAL(0.2402224208));
  p = fma(p, f, REAL(0.6931469776));
  p = fma(p, f, REAL(1.0));
  return p * power_of_two(n);
}

#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
