// What the device can do at most: the memory and arithmetic ceilings that the benchmarks hold other kernels against.
// One work-item per W elements, as the kernels they are compared with.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/real.h"

/// One plane in, one plane out.
kernel void copy_plane(global const float* in, global float* out, uint items) {
  const uint i = get_global_id(0);
  if (i < items) STORE(LOAD(in, i), out, i);
}

/// Planes that `read_planes` reads: -DPLANES=1 to 12.
#ifndef PLANES
#define PLANES 6
#endif
#define ADD(plane) (PLANES > plane ? LOAD(p##plane, i) : REAL(0.0))

/// The traffic of a kernel that reads PLANES planes and writes one, with next to no arithmetic.
kernel void read_planes(global const float* p0, global const float* p1, global const float* p2, global const float* p3,
                        global const float* p4, global const float* p5, global const float* p6, global const float* p7,
                        global const float* p8, global const float* p9, global const float* p10,
                        global const float* p11, global float* out, uint items) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  const real sum =
      ADD(0) + ADD(1) + ADD(2) + ADD(3) + ADD(4) + ADD(5) + ADD(6) + ADD(7) + ADD(8) + ADD(9) + ADD(10) + ADD(11);
  STORE(sum, out, i);
}

/// Arithmetic alone: 4 chains of 16 lanes of `steps` fused multiply-adds per work-item, 128 * steps operations.
/// x <- x / 2 + 1 goes to 2 from any start: the result shows that the work was done.
kernel void multiply_add(global float* out, uint steps, uint items) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  const float16 half_of = (float16)(0.5f), one = (float16)(1.0f);
  float16 a = (float16)((float)i), b = a + one, c = b + one, d = c + one;
  for (uint step = 0; step < steps; ++step) {
    a = fma(a, half_of, one);
    b = fma(b, half_of, one);
    c = fma(c, half_of, one);
    d = fma(d, half_of, one);
  }
  const float16 sum = a + b + c + d;
  const float8 eight = sum.lo + sum.hi;
  const float4 four = eight.lo + eight.hi;
  out[i] = (four.x + four.y + four.z + four.w) / 64.0f;
}
