// `obscurance-line`: the open share of the ball around each fragment from lines along the sight (Loos & Sloan 2010
// section 4.1), over that of a flat surface with the same lines. Of each line four pixels of a row are asked and
// their mean taken. A line whose point lies outside the image counts for neither. -DNORMALS: clamped by the
// tangent plane (4.4); -DCOSINE: of the ball on top of that plane; -DQUADRATIC: falloff 1 - r^2; -DTHICKNESS: surfaces
// end (4.3); -DRADII=1, 2: product or minimum of two radii. One work-item per W fragments; planes are padded.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/obscurance_entry.h"
#include "kernels/shared/obscurance_row.h"

#ifdef QUADRATIC
#define FALLOFF 1
#else
#define FALLOFF 0
#endif

/// `sum` and what is seen through one pixel of a row: -DTHICKNESS: twice what is hidden of the line, else what is open.
/// What is `step` metres beyond the fragment hides a line from step scale + a on, nothing of it from `beyond` on.
/// Lengths from where the line enters the ball; `length`: to its end.
SHARED real with_pixel(real sum, real step, real beyond, real scale, real a, real half_length, real length) {
  const real seen = PICK(step > beyond, FAR_AWAY, fma(step, scale, a));
#if defined(THICKNESS) && defined(QUADRATIC)
  return add_hidden_quadratic(sum, half_length, seen - half_length, length - half_length);
#elif defined(THICKNESS)
  return add_hidden(sum, seen, length);
#elif defined(QUADRATIC)
  return sum + line_integral(half_length, at_most(seen, length) - half_length, 1);
#else
  return sum + at_least(at_most(seen, length), REAL(0.0));
#endif
}

SHARED real ball_obscurance(global const float* depth, global uint* validity, global const ObscuranceRow* rows,
                            uint count, uint item, Pixels at, Receiver to, truth drawn, float radius,
                            const ObscuranceSetting* setting) {
  const Ball ball = ball_around(to, (real)(radius), (real)(setting->focal));
  const Turn turn = turn_of(at, to);
  const BallVector middle = middle_of_ball(to);
#ifdef THICKNESS
  // Thicker than 1024 is as good as endless, and the sums keep digits enough.
  const real unit = at_most((real)(2.0f * setting->thickness) * ball.per_radius, REAL(1024.0));
#else
  const real unit = REAL(1.0);
#endif
  const real per_unit = REAL(1.0) / unit;
  const RowDepths depths = row_depths(to, ball, (real)(radius), per_unit, setting);
  const int any_single = ANY(depths.single);
#ifdef THICKNESS
  const real nearest = fma(-middle.z, per_unit, REAL(1.0));  // of backs: from surfaces they are a unit behind
#else
  const real nearest = -middle.z;
#endif
  real open = REAL(0.0), flat = REAL(0.0);
  truth left = (truth)(0);
  for (uint row = 0; row < count; ++row) {
    const real half_length = (real)(rows[row].z) * per_unit;
    const DiscPoint goal = turned(turn, middle, (real)(rows[row].x), (real)(rows[row].y));
    const Row next = row_at(depth, at, ball, depths, any_single, goal.x, goal.y, setting);
    const real share = PICK(next.inside, (real)(rows[row].share), REAL(0.0));
    const real across = fma(to.sight_x, goal.x, to.sight_y * goal.y);
    const real plane = fma(per_unit, across, -fma(depths.rise_x, goal.x, depths.rise_y * goal.y));
    // What is seen beyond the ball hides nothing of it, however far in front of the plane.
    const real beyond = fma(-across, depths.radius_of_step, depths.radius_of_step);
#if defined(NORMALS) && !defined(COSINE)
    const real end = at_least(at_most(plane, half_length), -half_length);
#else
    const real end = half_length;  // of the ball on top of it, the plane cuts nothing
#endif
    real a = fma(depths.along_x, next.x, depths.along_y * next.y);
    const real length = end + half_length;
    real scale = fma(depths.scale_of_a, a, depths.base_scale);
    a += plane + (nearest + half_length);
    // Not a loop, which PoCL would take through memory.
    real sum = with_pixel(REAL(0.0), next.depths.a - to.depth, beyond, scale, a, half_length, length);
    a += depths.next_a;
    scale += depths.next_scale;
    sum = with_pixel(sum, next.depths.b - to.depth, beyond, scale, a, half_length, length);
    a += depths.next_pair_a;
    scale += depths.next_pair_scale;
    sum = with_pixel(sum, next.depths.c - to.depth, beyond, scale, a, half_length, length);
    a += depths.next_a;
    scale += depths.next_scale;
    sum = with_pixel(sum, next.depths.d - to.depth, beyond, scale, a, half_length, length);
#ifdef THICKNESS
    open = fma(share, fma(REAL(-0.125), sum, line_integral(half_length, end, FALLOFF)), open);
#else
    open = fma(REAL(0.25) * share, sum, open);
#endif
#ifdef NORMALS
    flat = fma(share, line_integral(half_length, end, FALLOFF), flat);
#else
    flat = fma(share, line_integral(half_length, REAL(0.0), FALLOFF), flat);
#endif
    left |= NOT(next.inside);
  }
  flag_samples(validity, item, ball, left, drawn, setting);
  const real size = FALLOFF ? unit * unit * unit : unit;
  return open_share(open * size, flat * size);
}

kernel void shade_obscurance_line(global const float* depth, global const float* normal_x, global const float* normal_y,
                                  global const float* normal_z, const ObscuranceSetting setting,
                                  global const ObscuranceRow* rows, uint count, uint items, global float* visibility,
                                  global uint* validity) {
  shade_balls(depth, normal_x, normal_y, normal_z, &setting, rows, count, items, visibility, validity);
}
