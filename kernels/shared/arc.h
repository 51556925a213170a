// Circular arcs of constant length: how limbs and blades bend. Scalar or vector `real`, no branches.
//   arc_sine(q)   = sin(f)/f        with q = f*f
//   arc_versine(q) = (1 - cos f)/f^2
// Minimax polynomials in q: absolute error below 1e-6 for |f| <= 2.5 rad (tests/kernels/arc_test.cpp), exact at f = 0.
#ifndef UNDERSTORY_ARC_H
#define UNDERSTORY_ARC_H

#include "kernels/shared/rounded.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

SHARED real arc_sine(real q) {
  real s = REAL(-2.2232981780e-8);
  s = fma(s, q, REAL(2.7366346244e-6));
  s = fma(s, q, REAL(-1.9835342784e-4));
  s = fma(s, q, REAL(8.3332527706e-3));
  s = fma(s, q, REAL(-1.6666663105e-1));
  return fma(s, q, REAL(1.0));
}

SHARED real arc_versine(real q) {
  real s = REAL(2.4527823661e-7);
  s = fma(s, q, REAL(-2.4644407713e-5));
  s = fma(s, q, REAL(1.3885645718e-3));
  s = fma(s, q, REAL(-4.1666457995e-2));
  return fma(s, q, REAL(0.5));
}

// sin(2 pi t) for t in turns, any |t| < 2^20; error below 1e-6. With r the rest of t in [-1/2, 1/2], the parabola
// y = 8 r (1 - 2 |r|) has the sine's zeros and extremes, and the sine is smooth in it: y times a cubic of |y|, minimax.
SHARED real sine_of_turns(real t) {
  const real r = t - rounded(t);
  const real y = r * fma(REAL(-16.0), fabs(r), REAL(8.0)), size = fabs(y);
  real s = REAL(8.567028982e-4);
  s = fma(s, size, REAL(1.7381181635e-2));
  s = fma(s, size, REAL(1.963655547e-1));
  s = fma(s, size, REAL(7.853965082e-1));
  return y * s;
}

#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
