// `obscurance-line`: the open share of the ball around each fragment from lines along the sight (Loos & Sloan 2010
// section 4.1), over that of a flat surface with the same lines. A line whose pixel lies outside the image counts for
// neither. -DNORMALS: clamped by the tangent plane (4.4); -DCOSINE: of the ball on top of that plane; -DQUADRATIC:
// falloff 1 - r^2; -DTHICKNESS: surfaces end (4.3); -DRADII=1, 2: product or minimum of two radii. One work-item per W
// fragments; planes are padded.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/obscurance_entry.h"

#ifdef QUADRATIC
#define FALLOFF 1
#else
#define FALLOFF 0
#endif

SHARED real ball_obscurance(global const float* depth, global uint* validity, global const ObscuranceRow* rows,
                            uint count, uint item, Pixels at, Receiver to, truth drawn, float radius,
                            const ObscuranceSetting* setting) {
  const Ball ball = ball_around(to, (real)(radius), (real)(setting->focal));
  const Turn turn = turn_of(at, to);
  const BallVector middle = middle_of_ball(to);
#ifdef THICKNESS
  const real deepest = (real)(2.0f * setting->thickness) * ball.per_radius, per_deepest = REAL(1.0) / deepest;
#endif
  real open = REAL(0.0), flat = REAL(0.0);
  truth left = (truth)(0);
  for (uint row = 0; row < count; ++row) {
    const real half_length = (real)(rows[row].z);
    const DiscPoint goal = turned(turn, middle, (real)(rows[row].x), (real)(rows[row].y));
    const Neighbour next = neighbour_at(depth, at, ball, goal.x, goal.y, setting);
    const real share = PICK(next.inside, (real)(rows[row].share), REAL(0.0));
    const real seen = seen_depth(to, ball, next.x, next.y, next.depth) - middle.z;
#ifdef NORMALS
    const real plane = plane_depth(to, ball, next.x, next.y).depth - middle.z;
    flat = fma(share, line_integral(half_length, plane, FALLOFF), flat);
#else
    const real plane = FAR_AWAY;
    flat = fma(share, line_integral(half_length, REAL(0.0), FALLOFF), flat);
#endif
    real length = line_integral(half_length, at_most(seen, plane), FALLOFF);
#ifdef THICKNESS
    length += behind_integral(half_length, seen, deepest, per_deepest, plane, FALLOFF);
#endif
    open = fma(share, length, open);
    left |= NOT(next.inside);
  }
  flag_samples(validity, item, ball, left, drawn, setting);
  return open_share(open, flat);
}

kernel void shade_obscurance_line(global const float* depth, global const float* normal_x, global const float* normal_y,
                                  global const float* normal_z, const ObscuranceSetting setting,
                                  global const ObscuranceRow* rows, uint count, uint items, global float* visibility,
                                  global uint* validity) {
  shade_balls(depth, normal_x, normal_y, normal_z, &setting, rows, count, items, visibility, validity);
}
