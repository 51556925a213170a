// Circular arcs of constant length: how limbs and blades bend. Scalar or vector `real`, no branches.
//   arc_sine(q)   = sin(f)/f        with q = f*f
//   arc_versine(q) = (1 - cos f)/f^2
// Taylor series to q^7: absolute error below 1e-6 for |f| <= 2.5 rad (tests/kernels/arc_test.cpp), exact at f = 0.
#ifndef UNDERSTORY_ARC_H
#define UNDERSTORY_ARC_H

#include "kernels/shared/real.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

SHARED real arc_sine(real q) {
  real s = REAL(-7.6471637e-13);       // -1/15!
  s = fma(s, q, REAL(1.6059044e-10));  //  1/13!
  s = fma(s, q, REAL(-2.5052108e-8));  // -1/11!
  s = fma(s, q, REAL(2.7557319e-6));   //  1/9!
  s = fma(s, q, REAL(-1.9841270e-4));  // -1/7!
  s = fma(s, q, REAL(8.3333333e-3));   //  1/5!
  s = fma(s, q, REAL(-1.6666667e-1));  // -1/3!
  return fma(s, q, REAL(1.0));
}

SHARED real arc_versine(real q) {
  real s = REAL(-4.7794773e-14);       // -1/16!
  s = fma(s, q, REAL(1.1470746e-11));  //  1/14!
  s = fma(s, q, REAL(-2.0876757e-9));  // -1/12!
  s = fma(s, q, REAL(2.7557319e-7));   //  1/10!
  s = fma(s, q, REAL(-2.4801587e-5));  // -1/8!
  s = fma(s, q, REAL(1.3888889e-3));   //  1/6!
  s = fma(s, q, REAL(-4.1666667e-2));  // -1/4!
  return fma(s, q, REAL(0.5));
}

// sin(2 pi t) for t in turns, any |t| < 2^20: reduced to half a turn, odd minimax-like series; error below 2e-6.
SHARED real sine_of_turns(real t) {
  t = t - rint(t);  // [-1/2, 1/2]
  real f = t * REAL(6.28318530718);
  // sin(f) = 2 sin(f/2) cos(f/2) keeps the series within |f/2| <= pi/2
  real h = REAL(0.5) * f, q = h * h;
  real s = h * arc_sine(q), c = REAL(1.0) - q * arc_versine(q);
  return REAL(2.0) * s * c;
}

#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
