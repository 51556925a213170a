// The W fragments of a work-item as receivers, and what the pixels around them show. OpenCL only.
#ifndef UNDERSTORY_OBSCURANCE_FRAGMENTS_H
#define UNDERSTORY_OBSCURANCE_FRAGMENTS_H

#include "kernels/shared/obscurance.h"
#include "kernels/shared/obscurance_setting.h"
#include "kernels/shared/rotation_pattern.h"
#include "kernels/shared/validity.h"

typedef struct {
  real x, y;   // pixel, whole numbers
  whole turn;  // of the rotation pattern
} Pixels;

SHARED Pixels pixels_of(uint item, const ObscuranceSetting* setting) {
  const int first = (int)(item * W);
  whole y = (whole)(first / setting->width);
  whole x = (whole)(first % setting->width) + LANE_NUMBERS;
  for (truth past = x >= (whole)(setting->width); ANY(past); past = x >= (whole)(setting->width)) {
    x = PICK(past, x - (whole)(setting->width), x);
    y = PICK(past, y + 1, y);
  }
  Pixels at;
  at.x = TO_REAL(x);
  at.y = TO_REAL(y);
  at.turn = pattern_index(x + (whole)(setting->first_x), y + (whole)(setting->first_y));
  return at;
}

/// Along right, down and forward.
typedef struct {
  real x, y, z;
} CameraVector;

/// Of a vector along the world's axes.
SHARED CameraVector in_camera_axes(real x, real y, real z, const ObscuranceSetting* setting) {
#define COMPONENT(axis) fma(x, (real)(setting->axis[0]), fma(y, (real)(setting->axis[1]), z * setting->axis[2]))
  const CameraVector vector = {COMPONENT(right), COMPONENT(down), COMPONENT(forward)};
#undef COMPONENT
  return vector;
}

SHARED Receiver receiver_of(Pixels at, real depth, real normal_x, real normal_y, real normal_z,
                            const ObscuranceSetting* setting) {
  const real per_focal = (real)(1.0f / setting->focal);
  const real x = (at.x + REAL(0.5) - setting->centre_x) * per_focal;
  const real y = (at.y + REAL(0.5) - setting->centre_y) * per_focal;
  const CameraVector normal = in_camera_axes(normal_x, normal_y, normal_z, setting);
  return receiver_at(x, y, depth, normal.x, normal.y, normal.z, (real)(setting->perspective));
}

/// Fragments that show something.
SHARED truth drawn_lanes(global const uint* validity, uint item) {
  return (LOAD(validity, item) & (bits)(VALIDITY_BACKGROUND | VALIDITY_NOT_FINITE)) == (bits)(0u);
}

/// What is seen some pixels away.
typedef struct {
  real x, y;     // of the pixel's centre from the fragment, in the image, radii
  real depth;    // camera z, m
  truth inside;  // the pixel is in the image
} Neighbour;

/// (x, y): radii in the image.
SHARED Neighbour neighbour_at(global const float* depth, Pixels at, Ball ball, real x, real y,
                              const ObscuranceSetting* setting) {
  const real u = fma(x, ball.pixels, at.x + REAL(0.5)), v = fma(y, ball.pixels, at.y + REAL(0.5));
  const real end_x = (real)((float)(setting->width)), end_y = (real)((float)(setting->height));
  // Cut off towards zero: `floor` of a vector costs nine instructions.
  const whole pixel_x = TO_WHOLE(at_least(at_most(u, end_x - REAL(1.0)), REAL(0.0)));
  const whole pixel_y = TO_WHOLE(at_least(at_most(v, end_y - REAL(1.0)), REAL(0.0)));
  const whole index = pixel_y * (whole)(setting->width) + pixel_x;
  Neighbour next;
  next.x = (TO_REAL(pixel_x) - at.x) * ball.per_pixel;
  next.y = (TO_REAL(pixel_y) - at.y) * ball.per_pixel;
  next.depth = GATHER(real, depth, index, );
  next.inside = (u >= REAL(0.0)) & (u < end_x) & (v >= REAL(0.0)) & (v < end_y);
  return next;
}

/// A reflection about a direction of the disc that changes from pixel to pixel, then from the disc to the image.
typedef struct {
  real xx, xy, yx, yy;
} Turn;

SHARED Turn turn_of(Pixels at, Receiver to) {
  const real angle = fma(TO_REAL(at.turn), REAL(0.0625), REAL(-0.5));
  const real c = cosine_of_turn(angle), s = sine_of_turn(angle);
  Turn turn;
  turn.xx = fma(to.spread_xx, c, to.spread_xy * s);
  turn.yx = fma(to.spread_xy, c, to.spread_yy * s);
  turn.xy = fma(to.spread_xx, s, -to.spread_xy * c);
  turn.yy = fma(to.spread_xy, s, -to.spread_yy * c);
  return turn;
}

/// Of the ball that samples fill, radii; x and y in the image. -DCOSINE: the largest ball in front of the tangent
/// plane, whose share of open lines weights directions like a cosine (Szirmay-Kalos et al. 2009, in section 4.4).
SHARED BallVector middle_of_ball(Receiver to) {
  BallVector middle = {REAL(0.0), REAL(0.0), REAL(0.0)};
#ifdef COSINE
  const BallVector normal = normal_in_ball(to);
  middle.x = REAL(0.5) * fma(to.spread_xx, normal.x, to.spread_xy * normal.y);
  middle.y = REAL(0.5) * fma(to.spread_xy, normal.x, to.spread_yy * normal.y);
  middle.z = REAL(0.5) * normal.z;
#endif
  return middle;
}

/// In the image, radii from the fragment.
typedef struct {
  real x, y;
} DiscPoint;

SHARED DiscPoint turned(Turn turn, BallVector middle, real x, real y) {
  DiscPoint to;
  to.x = fma(x, turn.xx, fma(y, turn.xy, middle.x));
  to.y = fma(x, turn.yx, fma(y, turn.yy, middle.y));
  return to;
}

/// Share of the weights that is open; 1 where no sample said anything.
SHARED real open_share(real open, real whole_share) {
  return as_visibility(PICK(whole_share > REAL(1e-6), open / whole_share, REAL(1.0)));
}

/// Codes 32 and 64 of FORMULAS.md: radius below a pixel or beyond the image; a sample left the image.
SHARED void flag_samples(global uint* validity, uint item, Ball ball, truth left, truth drawn,
                         const ObscuranceSetting* setting) {
  const real longest = (real)((float)max(setting->width, setting->height));
  const truth in_range = (ball.pixels >= REAL(1.0)) & (ball.pixels <= longest);
  const truth out_of_range = drawn & (in_range == (truth)(0));
  if (ANY(out_of_range)) add_validity(validity, item, out_of_range, VALIDITY_RADIUS_OUT_OF_RANGE);
  if (ANY(left & drawn)) add_validity(validity, item, left & drawn, VALIDITY_LEFT_IMAGE);
}

#endif
