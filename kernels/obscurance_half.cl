// Half resolution of the planes that obscurance reads: pixel (x, y) of the small image is pixel (2x, 2y) of the large
// one, unfiltered, since a mean of depths lies on no surface. Padding is background. One work-item per small pixel.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/validity.h"

kernel void halve_planes(global const float* depth, global const float* normal_x, global const float* normal_y,
                         global const float* normal_z, global const uint* validity, uint width, uint half_width,
                         uint half_count, uint half_padded, global float* half_depth, global float* half_normal_x,
                         global float* half_normal_y, global float* half_normal_z, global uint* half_validity) {
  const uint i = get_global_id(0);
  if (i >= half_padded) return;
  if (i >= half_count) {
    half_depth[i] = INFINITY;
    half_normal_x[i] = half_normal_y[i] = half_normal_z[i] = 0;
    half_validity[i] = VALIDITY_BACKGROUND;
    return;
  }
  const uint from = 2 * (i / half_width) * width + 2 * (i % half_width);
  half_depth[i] = depth[from];
  half_normal_x[i] = normal_x[from];
  half_normal_y[i] = normal_y[from];
  half_normal_z[i] = normal_z[from];
  half_validity[i] = validity[from];
}
