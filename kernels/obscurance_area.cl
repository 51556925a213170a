// `obscurance-area`: as obscurance_line.cl, but each line asks the moments of depth over its share of the disc instead of
// one pixel (Loos & Sloan 2010 section 4.2). -DSPREAD: half-width of the box of depths in standard deviations. What the
// tangent plane itself spreads is taken off first, so that a slant counts as flat. -DNORMALS, -DRADII as there;
// -DTHICKNESS: all is open from the thickness on. One work-item per W fragments; planes are padded.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/depth_moments.h"
#include "kernels/shared/obscurance_fragments.h"

#ifndef SPREAD
#define SPREAD 1.0f  // the paper's
#endif

typedef struct {
  real mean, variance, coverage;
  real plane_variance;  // pixels^2
} Moments;

/// Between the four texels around (x, y), pixels from the image's corner.
SHARED Moments moments_of_level(global const float* mean, global const float* variance, global const float* coverage,
                                global const MomentLevel* levels, whole level, real x, real y) {
  const real per_texel = AS_REAL((127 - level) << 23);  // 2^-level
  const whole first = AS_WHOLE(GATHER(bits, levels, level, .first));
  const whole width = GATHER(whole, levels, level, .width), height = GATHER(whole, levels, level, .height);
  const real u = fma(x, per_texel, REAL(-0.5)), v = fma(y, per_texel, REAL(-0.5));
  const real column = floor(u), row = floor(v);
  Moments sum = {REAL(0.0), REAL(0.0), REAL(0.0), GATHER(real, levels, level, .plane_variance)};
  for (int corner = 0; corner < 4; ++corner) {
    const real beside = REAL(1.0) - fabs(u - column - (real)((float)(corner & 1)));
    const real below = REAL(1.0) - fabs(v - row - (real)((float)(corner >> 1)));
    const whole at_x = clamp(TO_WHOLE(column) + (corner & 1), (whole)(0), width - 1);
    const whole at_y = clamp(TO_WHOLE(row) + (corner >> 1), (whole)(0), height - 1);
    const whole texel = first + at_y * width + at_x;
    const real weight = beside * below * GATHER(real, coverage, texel, );
    sum.mean = fma(weight, GATHER(real, mean, texel, ), sum.mean);
    sum.variance = fma(weight, GATHER(real, variance, texel, ), sum.variance);
    sum.coverage += weight;
  }
  return sum;
}

/// Over texels of `side` pixels around (x, y), between the two levels next to it.
SHARED Moments moments_at(global const float* mean, global const float* variance, global const float* coverage,
                          global const MomentLevel* levels, int level_count, real x, real y, real side) {
  // The exponent and the mantissa: a logarithm with straight pieces.
  const real size = at_least(at_most(side, REAL(65536.0)), REAL(1.0));
  const whole level = (AS_WHOLE(size) >> 23) - 127, last = (whole)(level_count - 1);
  const real between = size * AS_REAL((127 - level) << 23) - REAL(1.0);
  const Moments a = moments_of_level(mean, variance, coverage, levels, min(level, last), x, y);
  const Moments b = moments_of_level(mean, variance, coverage, levels, min(level + 1, last), x, y);
  Moments sum;
  sum.coverage = fma(between, b.coverage - a.coverage, a.coverage);
  const real per_coverage = REAL(1.0) / at_least(sum.coverage, REAL(1e-6));
  sum.mean = fma(between, b.mean - a.mean, a.mean) * per_coverage;
  sum.variance = fma(between, b.variance - a.variance, a.variance) * per_coverage;
  sum.plane_variance = fma(between, b.plane_variance - a.plane_variance, a.plane_variance);
  return sum;
}

SHARED real area_obscurance(global const float* mean, global const float* variance, global const float* coverage,
                            global const MomentLevel* levels, int level_count, global uint* validity,
                            global const ObscuranceRow* rows, uint count, uint item, Pixels at, Receiver to,
                            truth drawn, float radius, const ObscuranceSetting* setting) {
  const Ball ball = ball_around(to, (real)(radius), (real)(setting->focal));
  const real turn = fma(TO_REAL(at.turn), REAL(0.0625), REAL(-0.5));
  const real c = cosine_of_turn(turn), s = sine_of_turn(turn);
  const real xx = fma(to.spread_xx, c, to.spread_xy * s), yx = fma(to.spread_xy, c, to.spread_yy * s);
  const real xy = fma(to.spread_xx, s, -to.spread_xy * c), yy = fma(to.spread_xy, s, -to.spread_yy * c);
  // The level whose Gaussian, of deviation 2^l/2 pixels, is as wide as a square of the sample's area.
  const real side = ball.pixels * sqrt(3.14159265f / (3.0f * (float)count));
  const real spread_scale = to.ray_length * ball.per_radius * SPREAD;
#ifdef NORMALS
  const real slope = REAL(1.0) / (to.facing * to.scale * (real)(setting->focal));
  const real slope_square = fma(to.normal_x, to.normal_x, to.normal_y * to.normal_y) * slope * slope;
#endif
  const real end_x = (real)((float)setting->width), end_y = (real)((float)setting->height);
  real open = REAL(0.0), flat = REAL(0.0);
  truth left = (truth)(0);
  for (uint row = 0; row < count; ++row) {
    const real x = (real)(rows[row].x), y = (real)(rows[row].y), half_length = (real)(rows[row].z);
    const real o_x = fma(x, xx, y * xy), o_y = fma(x, yx, y * yy);
    const real goal_x = fma(o_x, ball.pixels, at.x + REAL(0.5)), goal_y = fma(o_y, ball.pixels, at.y + REAL(0.5));
    const real pixel_x = at_least(at_most(goal_x, end_x), REAL(0.0));
    const real pixel_y = at_least(at_most(goal_y, end_y), REAL(0.0));
    const truth inside = (goal_x == pixel_x) & (goal_y == pixel_y);
    const Moments moments = moments_at(mean, variance, coverage, levels, level_count, pixel_x, pixel_y, side);
    const truth perspective = to.perspective > REAL(0.5);
    const real depth = PICK(perspective, REAL(1.0) / at_least(moments.mean, REAL(1e-18)), -moments.mean);
#ifdef NORMALS
    const real own_variance = moments.plane_variance * slope_square * REAL(1.002);
    const real plane = plane_depth(to, ball, o_x, o_y);
#else
    const real own_variance = REAL(0.0);
    const real plane = FAR_AWAY;
#endif
    const real deviation = sqrt(at_least(moments.variance - own_variance, REAL(0.0)));
    const real spread = at_most(deviation * PICK(perspective, depth * depth, REAL(1.0)) * spread_scale, FAR_AWAY);
    const real seen = seen_depth(to, ball, o_x, o_y, depth);
    const real share = PICK(inside, (real)(rows[row].share), REAL(0.0));
    const real whole_line = line_integral(half_length, plane, 0);
    real length = box_integral(half_length, plane, seen, spread);
#ifdef THICKNESS
    const real back = fma((real)(setting->thickness), ball.per_radius, seen);
    length += whole_line - box_integral(half_length, plane, back, spread);
#endif
    const real covered = at_most(moments.coverage, REAL(1.0));
    open = fma(share, fma(covered, length - whole_line, whole_line), open);
#ifdef NORMALS
    flat = fma(share, whole_line, flat);
#else
    flat = fma(share, half_length, flat);
#endif
    left |= NOT(inside);
  }
  flag_samples(validity, item, ball, left, drawn, setting);
  return open_share(open, flat);
}

kernel void shade_obscurance_area(global const float* depth, global const float* normal_x, global const float* normal_y,
                                  global const float* normal_z, const ObscuranceSetting setting,
                                  global const float* mean, global const float* variance, global const float* coverage,
                                  global const MomentLevel* levels, int level_count, global const ObscuranceRow* rows,
                                  uint count, uint items, global float* visibility, global uint* validity) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  const truth drawn = (LOAD(validity, i) & (bits)(VALIDITY_BACKGROUND | VALIDITY_NOT_FINITE)) == (bits)(0u);
  if (!ANY(drawn)) {
    STORE(REAL(1.0), visibility, i);
    return;
  }
  const Pixels at = pixels_of(i, &setting);
  const Receiver to =
      receiver_of(at, LOAD(depth, i), LOAD(normal_x, i), LOAD(normal_y, i), LOAD(normal_z, i), &setting);
  real v = area_obscurance(mean, variance, coverage, levels, level_count, validity, rows, count, i, at, to, drawn,
                           setting.radius, &setting);
#ifdef RADII
  const real second = area_obscurance(mean, variance, coverage, levels, level_count, validity, rows, count, i, at, to,
                                      drawn, setting.second_radius, &setting);
  v = RADII == 1 ? v * second : at_most(v, second);
#endif
  STORE(PICK(drawn, v, REAL(1.0)), visibility, i);
}
