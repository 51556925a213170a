// `obscurance-line`: the open share of the ball around each fragment from lines along the sight (Loos & Sloan 2010
// section 4.1), over that of a flat surface with the same lines. A line whose pixel lies outside the image counts for
// neither. -DNORMALS: clamped by the tangent plane (4.4); -DQUADRATIC: falloff 1 - r^2; -DTHICKNESS: surfaces end (4.3);
// -DRADII=1, 2: product or minimum of two radii. One work-item per W fragments; planes are padded.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/obscurance_fragments.h"

#ifdef QUADRATIC
#define FALLOFF 1
#else
#define FALLOFF 0
#endif

SHARED real line_obscurance(global const float* depth, global uint* validity, global const ObscuranceRow* rows,
                            uint count, uint item, Pixels at, Receiver to, truth drawn, float radius,
                            const ObscuranceSetting* setting) {
  const Ball ball = ball_around(to, (real)(radius), (real)(setting->focal));
  const real turn = fma(TO_REAL(at.turn), REAL(0.0625), REAL(-0.5));
  // A reflection about a random direction, then from the disc to the image.
  const real c = cosine_of_turn(turn), s = sine_of_turn(turn);
  const real xx = fma(to.spread_xx, c, to.spread_xy * s), yx = fma(to.spread_xy, c, to.spread_yy * s);
  const real xy = fma(to.spread_xx, s, -to.spread_xy * c), yy = fma(to.spread_xy, s, -to.spread_yy * c);
  // The line through the fragment itself is open in front of it.
  real open = (real)(0.5f * setting->centre_share), flat = open;
#if defined(THICKNESS) && !defined(NORMALS)
  const real own_back = (real)(setting->thickness * (1.0f / radius));
  const real whole_line = line_integral(REAL(1.0), REAL(1.0), FALLOFF);
  open += setting->centre_share * behind_integral(REAL(1.0), own_back, REAL(1.0), FALLOFF) / whole_line;
#endif
  truth left = (truth)(0);
  for (uint row = 0; row < count; ++row) {
    const real x = (real)(rows[row].x), y = (real)(rows[row].y), half_length = (real)(rows[row].z);
    const Neighbour next = neighbour_at(depth, at, ball, fma(x, xx, y * xy), fma(x, yx, y * yy), setting);
    const real share = PICK(next.inside, (real)(rows[row].share), REAL(0.0));
    const real seen = seen_depth(to, ball, next.x, next.y, next.depth);
#ifdef NORMALS
    const real plane = plane_depth(to, ball, next.x, next.y).depth;
    flat = fma(share, line_integral(half_length, plane, FALLOFF), flat);
#else
    const real plane = FAR_AWAY;
    flat = fma(share, line_integral(half_length, REAL(0.0), FALLOFF), flat);
#endif
    real length = line_integral(half_length, at_most(seen, plane), FALLOFF);
#ifdef THICKNESS
    const real back = fma((real)(setting->thickness), ball.per_radius, seen);
    length += behind_integral(half_length, back, plane, FALLOFF);
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
  real v = line_obscurance(depth, validity, rows, count, i, at, to, drawn, setting.radius, &setting);
#ifdef RADII
  const real second = line_obscurance(depth, validity, rows, count, i, at, to, drawn, setting.second_radius, &setting);
  v = RADII == 1 ? v * second : at_most(v, second);
#endif
  STORE(PICK(drawn, v, REAL(1.0)), visibility, i);
}
