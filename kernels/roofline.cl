// What the device can do at most: the memory and arithmetic ceilings that the benchmarks hold other kernels against.
#pragma OPENCL FP_CONTRACT OFF

/// One plane in, one plane out.
kernel void copy_plane(global const float* in, global float* out, uint items) {
  const size_t i = get_global_id(0);
  if (i < items) out[i] = in[i];
}

/// The traffic of a kernel that shades fragments from position and normal, with next to no arithmetic.
kernel void read_six_write_one(global const float* a, global const float* b, global const float* c,
                               global const float* d, global const float* e, global const float* f,
                               global float* out, uint items) {
  const size_t i = get_global_id(0);
  if (i < items) out[i] = a[i] + b[i] + c[i] + d[i] + e[i] + f[i];
}

/// Arithmetic alone: 16 independent chains of `steps` fused multiply-adds per work-item, 32 * steps operations.
/// x <- x / 2 + 1 converges to 2 from any start: the result shows that the work was done.
kernel void multiply_add(global float* out, uint steps, uint items) {
  const size_t i = get_global_id(0);
  if (i >= items) return;
  float16 x = (float16)((float)i) + (float16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  for (uint step = 0; step < steps; ++step) x = fma(x, (float16)(0.5f), (float16)(1.0f));
  const float8 half_sum = x.lo + x.hi;
  const float4 quarter_sum = half_sum.lo + half_sum.hi;
  out[i] = (quarter_sum.x + quarter_sum.y + quarter_sum.z + quarter_sum.w) * 0.0625f;
}
