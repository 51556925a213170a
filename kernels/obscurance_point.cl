// `obscurance-point`: the open share of the ball around each fragment from points in it, the older form that Loos &
// Sloan 2010 compare with (section 2). Points are reflected about a random direction, and with -DNORMALS into the
// hemisphere of the normal (section 4.4); with -DCOSINE they fill the ball on top of the tangent plane instead.
// -DTHICKNESS: open again behind a surface; -DRADII=1, 2: product or minimum of two radii. The falloff is in the rows'
// shares. One work-item per W fragments; planes are padded.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/obscurance_entry.h"

/// A point of the plane, by rounding, is not behind it. Radii.
#define ON_THE_PLANE REAL(1e-4)

/// The k-th of 16 directions over a hemisphere: equal steps in z, golden section in azimuth.
SHARED BallVector mirror_direction(whole k) {
  const real number = TO_REAL(k);
  const real z = fma(number, REAL(0.0625), REAL(0.03125));
  const real turns = number * REAL(0.61803399), flat = sqrt(fma(-z, z, REAL(1.0)));
  const real turn = turns - floor(turns) - REAL(0.5);
  BallVector to;
  to.x = flat * cosine_of_turn(turn);
  to.y = flat * sine_of_turn(turn);
  to.z = z;
  return to;
}

SHARED BallVector reflected(BallVector p, BallVector by, real length) {
  BallVector to;
  to.x = fma(REAL(-2.0) * length, by.x, p.x);
  to.y = fma(REAL(-2.0) * length, by.y, p.y);
  to.z = fma(REAL(-2.0) * length, by.z, p.z);
  return to;
}

SHARED real along(BallVector p, BallVector q) { return fma(p.x, q.x, fma(p.y, q.y, p.z * q.z)); }

SHARED real ball_obscurance(global const float* depth, global uint* validity, global const ObscuranceRow* rows,
                            uint count, uint item, Pixels at, Receiver to, truth drawn, float radius,
                            const ObscuranceSetting* setting) {
  const Ball ball = ball_around(to, (real)(radius), (real)(setting->focal));
  const BallVector mirror = mirror_direction(at.turn);
#ifdef NORMALS
  const BallVector normal = normal_in_ball(to);
  const real per_facing = REAL(1.0) / normal.z;
  const real full = REAL(1.0);
#else
  const real full = REAL(0.5);
#endif
  real open = REAL(0.0), all = REAL(0.0);
  truth left = (truth)(0);
  for (uint row = 0; row < count; ++row) {
    const BallVector sample = {(real)(rows[row].x), (real)(rows[row].y), (real)(rows[row].z)};
    BallVector p = reflected(sample, mirror, along(sample, mirror));
#ifdef COSINE
    p.x = fma(normal.x, REAL(0.5), p.x);
    p.y = fma(normal.y, REAL(0.5), p.y);
    p.z = fma(normal.z, REAL(0.5), p.z);
    const real rise = along(p, normal);
#elif defined(NORMALS)
    const real rise = along(p, normal);
    p = reflected(p, normal, at_most(rise, REAL(0.0)));
#endif
    const Neighbour next = neighbour_at(depth, at, ball, fma(to.spread_xx, p.x, to.spread_xy * p.y),
                                        fma(to.spread_xy, p.x, to.spread_yy * p.y), setting);
    const real share = PICK(next.inside, (real)(rows[row].share), REAL(0.0));
    const real seen = seen_depth(to, ball, next.x, next.y, next.depth);
    real z = p.z;
#ifdef NORMALS
    // The pixel is not quite where the point is: there, keep the point as high above the plane as it is.
    const PlaneDepth plane = plane_depth(to, ball, next.x, next.y);
    z = PICK(plane.is_beyond, z, fma(fabs(rise), per_facing, plane.depth - ON_THE_PLANE));
#endif
#ifdef THICKNESS
    const real behind = at_most((z - seen) * (real)(0.5f * radius / setting->thickness), REAL(1.0));
#else
    const real behind = REAL(0.0);
#endif
    open = fma(share, PICK(z < seen, REAL(1.0), behind), open);
    all = fma(full, share, all);
    left |= NOT(next.inside);
  }
  flag_samples(validity, item, ball, left, drawn, setting);
  return open_share(open, all);
}

kernel void shade_obscurance_point(global const float* depth, global const float* normal_x,
                                   global const float* normal_y, global const float* normal_z,
                                   const ObscuranceSetting setting, global const ObscuranceRow* rows, uint count,
                                   uint items, global float* visibility, global uint* validity) {
  shade_balls(depth, normal_x, normal_y, normal_z, &setting, rows, count, items, visibility, validity);
}
