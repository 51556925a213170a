// What other programs' images may hold: positions or normals that are not finite (flagged; every pass makes them open)
// and normals of another length than 1 (flagged, and renormalised in place). Our own resolve pass never leaves any.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/limits.h"
#include "kernels/shared/validity.h"

#define LARGEST REAL(3.0e38)
#define UNIT_TOLERANCE REAL(1e-3)  // of the squared length: half-float normals pass

kernel void check_fragments(global const float* position_x, global const float* position_y,
                            global const float* position_z, global float* normal_x, global float* normal_y,
                            global float* normal_z, uint items, global uint* validity) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  const real x = LOAD(position_x, i), y = LOAD(position_y, i), z = LOAD(position_z, i);
  const real a = LOAD(normal_x, i), b = LOAD(normal_y, i), c = LOAD(normal_z, i);
  const bits codes = LOAD(validity, i);

  // Comparisons with NaN are false. Scaled by the largest component, no length overflows or vanishes.
  const truth finite = (fabs(x) < LARGEST) & (fabs(y) < LARGEST) & (fabs(z) < LARGEST) & (fabs(a) < LARGEST) &
                       (fabs(b) < LARGEST) & (fabs(c) < LARGEST);
  const real largest = at_least(at_least(fabs(a), fabs(b)), fabs(c));
  const real scale = REAL(1.0) / at_least(largest, REAL(1e-30));
  const real u = a * scale, v = b * scale, w = c * scale;
  const real shrink = REAL(1.0) / sqrt(at_least(fma(u, u, fma(v, v, w * w)), REAL(1e-30)));
  const truth unit = fabs(fma(a, a, fma(b, b, c * c)) - REAL(1.0)) < UNIT_TOLERANCE;
  const truth drawn = (codes & (bits)(VALIDITY_BACKGROUND)) == (bits)(0u);
  // A normal without a direction cannot be mended.
  const truth lost = drawn & NOT(finite & (largest > REAL(1e-30)));
  const truth mended = drawn & finite & (largest > REAL(1e-30)) & NOT(unit);

  STORE(PICK(mended, u * shrink, a), normal_x, i);
  STORE(PICK(mended, v * shrink, b), normal_y, i);
  STORE(PICK(mended, w * shrink, c), normal_z, i);
  STORE(codes | PICK(lost, (bits)(VALIDITY_NOT_FINITE), (bits)(0u)) |
            PICK(mended, (bits)(VALIDITY_NOT_UNIT), (bits)(0u)),
        validity, i);
}
