// The pyramid of shared/depth_moments.h. `take_depths` fills the finest level, `halve_moments` makes each next one with
// the taps 1 3 3 1 in both directions: a Gaussian before down-sampling (Loos & Sloan 2010 section 4.2). Background does
// not count; `coverage` is the share that does. One work-item per texel.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/depth_moments.h"
#include "kernels/shared/validity.h"

kernel void take_depths(global const float* depth, global const uint* validity, uint count, uint perspective,
                        global float* mean, global float* variance, global float* coverage) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const float value = perspective ? 1.0f / depth[i] : -depth[i];
  const int counts = !(validity[i] & (VALIDITY_BACKGROUND | VALIDITY_NOT_FINITE)) && fabs(value) < 1e18f;
  mean[i] = counts ? value : 0.0f;
  variance[i] = 0.0f;
  coverage[i] = counts ? 1.0f : 0.0f;
}

kernel void halve_moments(const MomentLevel from, const MomentLevel to, global float* mean, global float* variance,
                          global float* coverage) {
  const int i = (int)get_global_id(0);
  if (i >= to.width * to.height) return;
  const int x = 2 * (i % to.width) - 1, y = 2 * (i / to.width) - 1;
  const float taps[4] = {1, 3, 3, 1};
  float covered = 0, all = 0, sum = 0;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) {
      if (x + column < 0 || y + row < 0 || x + column >= from.width || y + row >= from.height) continue;
      const uint texel = from.first + (uint)((y + row) * from.width + x + column);
      const float weight = taps[row] * taps[column], counting = weight * coverage[texel];
      all += weight;
      covered += counting;
      sum = fma(counting, mean[texel], sum);
    }
  const float centre = covered > 0 ? sum / covered : 0.0f;
  float spread = 0;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) {
      if (x + column < 0 || y + row < 0 || x + column >= from.width || y + row >= from.height) continue;
      const uint texel = from.first + (uint)((y + row) * from.width + x + column);
      const float counting = taps[row] * taps[column] * coverage[texel], off = mean[texel] - centre;
      spread = fma(counting, fma(off, off, variance[texel]), spread);
    }
  const uint texel = to.first + (uint)i;
  mean[texel] = centre;
  variance[texel] = covered > 0 ? spread / covered : 0.0f;
  coverage[texel] = covered / all;
}
