// One direction of an edge-aware blur of obscurance: the mean over pixels along a row or column that lie on the same
// surface, by height over the fragment's tangent plane and by normal (Loos & Sloan 2010 section 4.1). The outermost two
// count half, so that a radius of 4 covers the 4 x 4 rotation pattern evenly. One work-item per W fragments.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/obscurance_fragments.h"
#include "kernels/shared/surface_weight.h"

// A plane's values `offset` fragments away: contiguous, but for the first and last work-items of the planes.
#define SHIFTED(plane)                                                                                 \
  (fits ? LOAD((plane) + offset, i) : GATHER(real, plane, clamp(elements, (whole)(0), (whole)(last)), ))

kernel void blur_obscurance(global const float* unblurred, global const float* depth, global const float* normal_x,
                            global const float* normal_y, global const float* normal_z, const ObscuranceSetting setting,
                            int radius, int down, float reach, uint items, global const uint* validity,
                            global float* visibility) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  const truth drawn = (LOAD(validity, i) & (bits)(VALIDITY_BACKGROUND | VALIDITY_NOT_FINITE)) == (bits)(0u);
  const real own = LOAD(unblurred, i);
  if (!ANY(drawn)) {
    STORE(own, visibility, i);
    return;
  }
  const Pixels at = pixels_of(i, &setting);
  const real a = LOAD(normal_x, i), b = LOAD(normal_y, i), c = LOAD(normal_z, i);
  const Receiver to = receiver_of(at, LOAD(depth, i), a, b, c, &setting);
  const real per_focal = (real)(1.0f / setting.focal);
  TangentPlane plane;
  plane.depth = to.depth;
  plane.facing = to.facing;
  plane.across_x = to.normal_x * per_focal;
  plane.across_y = to.normal_y * per_focal;
  plane.scale = to.scale;
  plane.perspective = to.perspective;

  const int last = (int)(items * W) - 1;
  const real along = down ? at.y : at.x, end = (real)((float)((down ? setting.height : setting.width) - 1));
  const real per_reach = (real)(1.0f / reach);
  real sum = own, weights = REAL(1.0);
  for (int step = -radius; step <= radius; ++step) {
    if (step == 0) continue;
    const int offset = down ? step * setting.width : step;
    const int first = (int)(i * W) + offset;
    const bool fits = first >= 0 && first + W - 1 <= last;
    const whole elements = (whole)(first) + LANE_NUMBERS;
    const real goal = along + (real)((float)step);
    const real height = height_over(plane, down ? REAL(0.0) : (real)((float)step), down ? (real)((float)step) : REAL(0.0),
                                    SHIFTED(depth));
    const real cosine = fma(a, SHIFTED(normal_x), fma(b, SHIFTED(normal_y), c * SHIFTED(normal_z)));
    const real end_weight = (step == radius || step == -radius) ? REAL(0.5) : REAL(1.0);
    const truth inside = (goal >= REAL(0.0)) & (goal <= end);
    const real weight = PICK(inside, end_weight * surface_weight(height, per_reach, cosine), REAL(0.0));
    sum = fma(weight, SHIFTED(unblurred), sum);
    weights += weight;
  }
  STORE(PICK(drawn, as_visibility(sum / weights), own), visibility, i);
}
