// What the device can do at most: the ceilings that the benchmarks hold other kernels against.
// One work-item per W elements, as the kernels they are compared with.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/exp_minus.h"
#include "kernels/shared/real.h"

/// One plane in, one plane out.
kernel void copy_plane(global const float* in, global float* out, uint items) {
  const uint i = get_global_id(0);
  if (i < items) STORE(LOAD(in, i), out, i);
}

/// STREAM's triad: a = b + s c.
kernel void triad(global const float* b, global const float* c, float s, global float* a, uint items) {
  const uint i = get_global_id(0);
  if (i < items) STORE(fma((real)(s), LOAD(c, i), LOAD(b, i)), a, i);
}

/// Planes that `stream_planes` reads: -DREAD=1 to 12, and writes: -DWRITTEN=1 to 12.
#ifndef READ
#define READ 6
#endif
#ifndef WRITTEN
#define WRITTEN 1
#endif
#define ADD(plane) (READ > plane ? LOAD(p##plane, i) : REAL(0.0))
#define PUT(plane) \
  if (WRITTEN > plane) STORE(sum, q##plane, i)

/// The traffic of a kernel that reads READ planes and writes WRITTEN, with next to no arithmetic.
kernel void stream_planes(global const float* p0, global const float* p1, global const float* p2,
                          global const float* p3, global const float* p4, global const float* p5,
                          global const float* p6, global const float* p7, global const float* p8,
                          global const float* p9, global const float* p10, global const float* p11, global float* q0,
                          global float* q1, global float* q2, global float* q3, global float* q4, global float* q5,
                          global float* q6, global float* q7, global float* q8, global float* q9, global float* q10,
                          global float* q11, uint items) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  const real sum =
      ADD(0) + ADD(1) + ADD(2) + ADD(3) + ADD(4) + ADD(5) + ADD(6) + ADD(7) + ADD(8) + ADD(9) + ADD(10) + ADD(11);
  PUT(0);
  PUT(1);
  PUT(2);
  PUT(3);
  PUT(4);
  PUT(5);
  PUT(6);
  PUT(7);
  PUT(8);
  PUT(9);
  PUT(10);
  PUT(11);
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

/// `steps` exponentials for each of two chains of W lanes. x <- exp(-x) goes to 0.567143 from any start.
kernel void exponentials(global float* out, uint steps, uint items) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  real a = REAL(0.1), b = REAL(2.0);
  for (uint step = 0; step < steps; ++step) {
    a = exp_minus(a);
    b = exp_minus(b);
  }
  STORE(REAL(0.5) * (a + b), out, i);
}

/// `steps` loads for each of W lanes, all over a table of `mask` + 1 elements (a power of two) that holds ones.
kernel void gather(global const float* table, uint mask, global float* out, uint steps, uint items) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  bits at = (bits)(i * 2654435761u);
#if W == 4
  at += (uint4)(0, 1, 2, 3) * 40503u;
#elif W == 8
  at += (uint8)(0, 1, 2, 3, 4, 5, 6, 7) * 40503u;
#elif W == 16
  at += (uint16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15) * 40503u;
#endif
  real sum = REAL(0.0);
  for (uint step = 0; step < steps; ++step) {
    at = at * 1664525u + 1013904223u;
    const bits element = (at >> 8) & (bits)(mask);
    sum += GATHER(real, table, element, );
  }
  STORE(sum, out, i);
}

/// `steps` atomic minima per work-item, all over a table of `mask` + 1 elements: 64 bits wide where the device has
/// them, as the visibility buffer's (visibility_buffer.h).
#ifdef UNDERSTORY_ATOMIC64
#pragma OPENCL EXTENSION cl_khr_int64_base_atomics : enable
#pragma OPENCL EXTENSION cl_khr_int64_extended_atomics : enable
#define CELL ulong
#define MINIMUM atom_min
#else
#define CELL uint
#define MINIMUM atomic_min
#endif
kernel void atomic_minima(global CELL* table, uint mask, uint steps, uint items) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  uint at = i * 2654435761u;
  for (uint step = 0; step < steps; ++step) {
    at = at * 1664525u + 1013904223u;
    MINIMUM(table + ((at >> 8) & mask), (CELL)(at | 1u));
  }
}
