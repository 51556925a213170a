// Volumetric obscurance (Loos & Sloan 2010 section 4): how much of the ball around a fragment is in front of the depth
// plane. Here the ball's disc faces the fragment's own line of sight, not the camera's axis, and samples are compared
// with the fragment's tangent plane where they are seen (lines and points by height above it, areas by where their own
// ray cuts it), so that a flat surface is open at any field of view (FORMULAS.md). Lengths along the line of sight are
// in units of the ball's radius, away from the camera, from the fragment.
#ifndef UNDERSTORY_OBSCURANCE_H
#define UNDERSTORY_OBSCURANCE_H

#include "kernels/shared/limits.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

/// A depth behind everything.
#define FAR_AWAY REAL(1e6)
/// A plane seen at less than this, cosine times the length of the ray, counts as seen edge-on.
#define EDGE_ON REAL(-1e-3)

/// A fragment as its samples need it. Vectors in camera axes: right, down, forward.
typedef struct {
  real normal_x, normal_y, normal_z;
  real ray_x, ray_y, ray_length;         // the ray through the fragment, forward component 1
  real sight_x, sight_y, sight_z;        // unit direction of that ray
  real per_sight;                        // 1/(1 + sight_z)
  real facing;                           // normal times ray, negative
  real depth;                            // camera z, m
  real scale;                            // m across at the fragment's depth per unit of x/z; orthographic: 1
  real spread_xx, spread_xy, spread_yy;  // disc to image: the disc faces the line of sight, the image the axis
  real perspective;
} Receiver;

/// The ball of radius r around a receiver.
typedef struct {
  real per_radius;  // 1/r, 1/m
  real pixels;      // r in the image, pixels
  real per_pixel;   // 1/pixels
  real widening;    // r over the depth: how much rays spread over the ball; orthographic: 0
} Ball;

/// (x, y): of the pixel, from the principal point, over the focal length. The normal's length is 1.
SHARED Receiver receiver_at(real x, real y, real depth, real normal_x, real normal_y, real normal_z, real perspective) {
  Receiver to;
  to.normal_x = normal_x;
  to.normal_y = normal_y;
  to.normal_z = normal_z;
  to.ray_x = perspective * x;
  to.ray_y = perspective * y;
  to.ray_length = sqrt(fma(to.ray_x, to.ray_x, fma(to.ray_y, to.ray_y, REAL(1.0))));
  to.sight_z = REAL(1.0) / to.ray_length;
  to.sight_x = to.ray_x * to.sight_z;
  to.sight_y = to.ray_y * to.sight_z;
  to.facing = at_most(fma(normal_x, to.ray_x, fma(normal_y, to.ray_y, normal_z)), EDGE_ON);
  to.depth = depth;
  to.scale = fma(perspective, depth, REAL(1.0) - perspective);
  // Two unit vectors square to the line of sight, (1 - a^2/(1+c), -ab/(1+c), -a) and its twin, seen along the ray.
  to.per_sight = REAL(1.0) / (REAL(1.0) + to.sight_z);
  const real over = to.ray_length - to.per_sight;
  to.spread_xx = fma(to.sight_x * to.sight_x, over, REAL(1.0));
  to.spread_xy = to.sight_x * to.sight_y * over;
  to.spread_yy = fma(to.sight_y * to.sight_y, over, REAL(1.0));
  to.perspective = perspective;
  return to;
}

SHARED Ball ball_around(Receiver to, real radius, real focal) {
  Ball ball;
  const real per_scale = REAL(1.0) / to.scale;
  ball.per_radius = REAL(1.0) / radius;
  ball.pixels = focal * radius * per_scale;
  ball.per_pixel = to.scale * (REAL(1.0) / (focal * radius));
  ball.widening = to.perspective * radius * per_scale;
  return ball;
}

/// Along the disc's two axes and the sight.
typedef struct {
  real x, y, z;
} BallVector;

SHARED BallVector normal_in_ball(Receiver to) {
  const real share = fma(fma(to.normal_x, to.sight_x, to.normal_y * to.sight_y), to.per_sight, to.normal_z);
  BallVector normal;
  normal.x = fma(-to.sight_x, share, to.normal_x);
  normal.y = fma(-to.sight_y, share, to.normal_y);
  normal.z = to.facing * to.sight_z;
  return normal;
}

/// Depth along the line of sight of a point on that ray whose camera z is `depth_step` radii beyond the fragment's.
SHARED real along_sight(Receiver to, Ball ball, real x, real y, real depth_step) {
  const real across = fma(to.sight_x, x, to.sight_y * y);
  // The ray's length along the line of sight, kept positive for rays at a right angle to it.
  return fma(depth_step, at_least(fma(ball.widening, across, to.ray_length), REAL(1e-3)), across);
}

/// Where the ray of the pixel that is (x, y) radii away in the image meets the tangent plane: depth along the line of
/// sight, radii; FAR_AWAY where it never does.
SHARED real plane_depth(Receiver to, Ball ball, real x, real y) {
  const real rise = fma(to.normal_x, x, to.normal_y * y);
  const real facing = fma(ball.widening, rise, to.facing);
  return PICK(facing > EDGE_ON, FAR_AWAY, along_sight(to, ball, x, y, -rise / at_most(facing, EDGE_ON)));
}

/// Depth along the line of sight of what the pixel shows; background, whose depth is infinite, is far away.
SHARED real seen_depth(Receiver to, Ball ball, real x, real y, real depth) {
  return at_most(along_sight(to, ball, x, y, (depth - to.depth) * ball.per_radius), FAR_AWAY);
}

/// Integral of the falloff along a line, from where it enters the ball to `depth`; `half`: half the line's length.
SHARED real line_integral(real half_length, real depth, int quadratic) {
  const real end = at_least(at_most(depth, half_length), -half_length);
  if (!quadratic) return end + half_length;
  // Of half^2 - z^2, section 4: 1 - r^2 along the line.
  const real square = half_length * half_length;
  return fma(end, fma(end * end, REAL(-0.33333333333333333), square), REAL(0.66666666666666667) * square * half_length);
}

/// `sum` and twice what a surface hides of a line of this length with constant falloff: all at the surface, evenly less
/// up to a unit of length behind it, at `back`, from where the line enters the ball, where it ends. Section 4.3 with
/// openness that grows evenly instead of a step: of leaves behind leaves nothing is known but that the farther behind
/// the first, the less they hide. All lengths in that unit.
SHARED real add_hidden(real sum, real back, real length) {
  // The antiderivative of 1 - z is -(1 - z)^2/2.
  const real first = at_least(at_most(back, REAL(1.0)), REAL(0.0));
  const real last = at_least(at_most(back - length, REAL(1.0)), REAL(0.0));
  return fma(-last, last, fma(first, first, sum));
}

/// Likewise with quadratic falloff; `back` and `end`, of the line, from its middle.
SHARED real add_hidden_quadratic(real sum, real half_length, real back, real end) {
  const real from = at_least(at_most(back - REAL(1.0), end), -half_length),
             to = at_least(at_most(back, end), -half_length);
  // Of z (half^2 - z^2), for the part that grows.
  const real square = half_length * half_length, f2 = from * from, t2 = to * to;
  const real moment = REAL(0.25) * (t2 - f2) * (square + square - t2 - f2);
  const real length = line_integral(half_length, to, 1) - line_integral(half_length, from, 1);
  return fma(REAL(2.0), fma(back, length, -moment), sum);
}

/// As line_integral with constant falloff, in front of depths that are spread evenly over mean +- spread (section 4.2):
/// openness falls from 1 to 0 over them, a = -1/(2 spread), b = (mean + spread)/(2 spread). `end`: of the plane.
SHARED real box_integral(real half_length, real end, real mean, real spread) {
  // Below this a step: what the ramp holds is less than the rounding of depths.
  const real s = at_least(spread, REAL(1e-5));
  const real e = at_least(at_most(end, half_length), -half_length);
  const real z0 = at_least(at_most(mean - s, e), -half_length), z1 = at_least(at_most(mean + s, e), -half_length);
  const real ramp = (z1 - z0) * ((mean - z0) + (mean - z1) + REAL(2.0) * s) / (REAL(4.0) * s);
  return z0 + half_length + ramp;
}

#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
