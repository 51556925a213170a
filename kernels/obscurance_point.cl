// `obscurance-point`: the open share of the ball around each fragment from points in it, the older form that Loos &
// Sloan 2010 compare with (section 2). Points are reflected about a random direction, and with -DNORMALS into the
// hemisphere of the normal (section 4.4); with -DCOSINE they fill the ball on top of the tangent plane instead.
// -DTHICKNESS: open again behind a surface; -DRADII=1, 2: product or minimum of two radii. The falloff is in the rows'
// shares. One work-item per W fragments; planes are padded.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/obscurance_entry.h"

/// What is on the plane, by rounding, hides nothing. Radii of camera depth.
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

/// Where a point of the ball is seen, radii from the fragment at the fragment's depth.
typedef struct {
  real x, y;
  truth in_front;  // of the camera: else it is nowhere in the image
} PointInImage;

SHARED PointInImage in_image(Receiver to, Ball ball, BallVector p) {
  const real beyond = fma(p.z, to.sight_z, -fma(p.x, to.sight_x, p.y * to.sight_y));
  const real depth = fma(ball.widening, beyond, REAL(1.0)), scale = REAL(1.0) / at_least(depth, REAL(1e-3));
  PointInImage seen;
  seen.x = fma(to.spread_xx, p.x, to.spread_xy * p.y) * scale;
  seen.y = fma(to.spread_xy, p.x, to.spread_yy * p.y) * scale;
  seen.in_front = depth > REAL(1e-3);
  return seen;
}

#ifdef NORMALS
/// Of what a pixel shows above the tangent plane, radii. Heights are comparable only where the pixel's ray falls
/// towards the plane; a plane that counts as seen edge-on has none that are.
typedef struct {
  real height;
  truth is_known;  // the ray falls towards the plane
} SeenHeight;

SHARED SeenHeight seen_height(Receiver to, Ball ball, Neighbour next) {
  const real rise = fma(to.normal_x, next.x, to.normal_y * next.y);
  const real facing = fma(ball.widening, rise, to.facing);
  SeenHeight seen;
  seen.height = fma((next.depth - to.depth) * ball.per_radius, facing, rise);
  seen.is_known = facing < EDGE_ON;
  return seen;
}
#endif

SHARED real ball_obscurance(global const float* depth, global uint* validity, global const ObscuranceRow* rows,
                            uint count, uint item, Pixels at, Receiver to, truth drawn, float radius,
                            const ObscuranceSetting* setting) {
  const Ball ball = ball_around(to, (real)(radius), (real)(setting->focal));
  const BallVector mirror = mirror_direction(at.turn);
#ifdef NORMALS
  const BallVector normal = normal_in_ball(to);
  const real on_plane = ON_THE_PLANE * to.facing;
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
    const real height = along(p, normal);
#elif defined(NORMALS)
    const real height = along(p, normal);
    p = reflected(p, normal, at_most(height, REAL(0.0)));
#endif
    const PointInImage goal = in_image(to, ball, p);
    Neighbour next = neighbour_at(depth, at, ball, goal.x, goal.y, setting);
    next.inside &= goal.in_front;
    const real share = PICK(next.inside, (real)(rows[row].share), REAL(0.0));
    const real hidden = p.z - seen_depth(to, ball, next.x, next.y, next.depth);
    truth is_open = hidden < REAL(0.0);
#ifdef NORMALS
    // The pixel's centre is not quite where the point is: along the plane it is carried there. On a ray that falls
    // towards the plane, what is higher is in front; a depth that is no number hides nothing.
    const SeenHeight seen = seen_height(to, ball, next);
    is_open = PICK(seen.is_known, NOT(seen.height + on_plane >= fabs(height)), is_open);
#endif
#ifdef THICKNESS
    const real per_thickness = (real)(0.5f * radius / setting->thickness);
    const real behind = at_least(at_most(hidden * per_thickness, REAL(1.0)), REAL(0.0));
#else
    const real behind = REAL(0.0);
#endif
    open = fma(share, PICK(is_open, REAL(1.0), behind), open);
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
