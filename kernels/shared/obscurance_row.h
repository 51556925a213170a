// Four pixels of a row that stand for a line of `obscurance-line`, where they are and what they show: neighbours, or
// every second one where the ball is large. OpenCL only.
#ifndef UNDERSTORY_OBSCURANCE_ROW_H
#define UNDERSTORY_OBSCURANCE_ROW_H

#include "kernels/shared/obscurance_fragments.h"

/// Below this radius in the image, pixels, a row would reach over too much of the ball: one pixel stands for a line.
#define LEAST_ROW_RADIUS REAL(4.0)
/// From this radius on, pixels, rows are of every second pixel: neighbours say nearly the same of a large ball.
#define LEAST_WIDE_RADIUS REAL(24.0)

/// How deep what pixels show is along the sight, in units of `unit` radii. With `step`, m, how far the camera z of the
/// pixel (x, y) pixels from the fragment is beyond the fragment's:
///   step (base_scale + scale_of_a a) + a,  a = along_x x + along_y y.
/// From the fragment on; with -DNORMALS from the tangent plane on, 0 for all that the plane itself shows: as far in
/// front of it as it is, a surface is carried along the plane to the line that asks.
typedef struct {
  real along_x, along_y;  // 1/pixel
  real base_scale;        // 1/m
  real scale_of_a;        // 1/m
  real next_a;            // of a, from the first of a pair of pixels to the second; 0 where one stands for the line
  real next_pair_a;       // from the second of the first pair to the first of the second, likewise
  real next_scale, next_pair_scale;  // of what `step` is multiplied with, likewise
  real rise_x, rise_y;               // of a, for a radius in the image
  real radius_of_step;               // `step` of what is a radius beyond the fragment on its own ray, m
  truth single;                      // one pixel stands for a line
  truth wide;                        // every second pixel
} RowDepths;

SHARED RowDepths row_depths(Receiver to, Ball ball, real radius, real per_unit, const ObscuranceSetting* setting) {
  RowDepths row;
#ifdef NORMALS
  const real per_facing = per_unit * to.ray_length / to.facing;
  row.rise_x = to.normal_x * per_facing;
  row.rise_y = to.normal_y * per_facing;
#else
  row.rise_x = per_unit * to.sight_x;
  row.rise_y = per_unit * to.sight_y;
#endif
  row.along_x = row.rise_x * ball.per_pixel;
  row.along_y = row.rise_y * ball.per_pixel;
  row.base_scale = per_unit * to.ray_length * ball.per_radius;
  row.scale_of_a = ball.widening * ball.per_radius;
  row.single = (ball.pixels < LEAST_ROW_RADIUS) | ((whole)(setting->width) < (whole)(4));
  row.wide = (ball.pixels >= LEAST_WIDE_RADIUS) & ((whole)(setting->width) >= (whole)(7));
  row.next_a = PICK(row.single, REAL(0.0), row.along_x + row.along_x);
  row.next_pair_a = PICK(row.single, REAL(0.0), PICK(row.wide, row.next_a, -row.along_x));
  row.next_scale = row.next_a * row.scale_of_a;
  row.next_pair_scale = row.next_pair_a * row.scale_of_a;
  row.radius_of_step = radius * to.sight_z;
  return row;
}

/// Depths of four pixels for each lane, m: a and b of pixels 0 and 2 of the row, c and d of 1 and 3, of a wide row of 4
/// and 6. In this order shuffles of even and odd elements bring them.
typedef struct {
  real a, b, c, d;
} RowPixels;

#ifdef __clang__
typedef float4 loose_float4 __attribute__((aligned(4)));
#define FOUR_FROM(plane, index) (*(global const loose_float4*)((plane) + (index)))
#else
#define FOUR_FROM(plane, index) vload4(0, (plane) + (index))
#endif

#if defined(__clang__) && defined(__AVX512F__) && W == 16
// An end to what the compiler merges: it would make the shuffles of both steps one, of a dozen steps with a table each.
#define SETTLED(vector) __asm__("" : "+v"(vector))
// Lanes' numbers by way of memory: one instruction each, where two or three take them out of a vector. `vector` is a
// variable of the function's own, which the compiler must think written.
#define NUMBERS_OF(name, vector) \
  __asm__("" : "+m"(vector));    \
  const PRIVATE int* name = (const PRIVATE int*)&(vector)
#define NUMBER(name, lane) name[0x##lane]
#else
#define SETTLED(vector)
#define NUMBERS_OF(name, vector) const whole name = vector
#define NUMBER(name, lane) name.s##lane
#endif

// A vector from what `quarter` names of each four elements: shuffles that never leave their 128 bits.
#if W == 4
#define BY_QUARTERS(quarter) (quarter(0, 1, 2, 3))
#elif W == 8
#define BY_QUARTERS(quarter) (quarter(0, 1, 2, 3), quarter(4, 5, 6, 7))
#elif W == 16
#define BY_QUARTERS(quarter) (quarter(0, 1, 2, 3), quarter(4, 5, 6, 7), quarter(8, 9, a, b), quarter(c, d, e, f))
#endif

#if W > 1
/// From vectors of four neighbours for every fourth lane (from the first, second, third, fourth lane on) to vectors of
/// one pixel for all lanes: the first, third, second, fourth neighbour.
SHARED RowPixels by_pixel(real from_first, real from_second, real from_third, real from_fourth) {
#define EVEN(i, j, k, l) x.s##i, x.s##k, y.s##i, y.s##k
#define ODD(i, j, k, l) x.s##j, x.s##l, y.s##j, y.s##l
  SETTLED(from_first);
  SETTLED(from_second);
  SETTLED(from_third);
  SETTLED(from_fourth);
  real x = from_first, y = from_second;
  real low_even = (real)BY_QUARTERS(EVEN), low_odd = (real)BY_QUARTERS(ODD);
  x = from_third, y = from_fourth;
  real high_even = (real)BY_QUARTERS(EVEN), high_odd = (real)BY_QUARTERS(ODD);
  SETTLED(low_even);
  SETTLED(low_odd);
  SETTLED(high_even);
  SETTLED(high_odd);
  RowPixels row;
  x = low_even, y = high_even;
  row.a = (real)BY_QUARTERS(EVEN);
  row.b = (real)BY_QUARTERS(ODD);
  x = low_odd, y = high_odd;
  row.c = (real)BY_QUARTERS(EVEN);
  row.d = (real)BY_QUARTERS(ODD);
#undef EVEN
#undef ODD
  return row;
}
#endif

/// Of plane[index] to plane[index + 6], which must all be there, those that `RowPixels` names. Two loads a lane, the
/// second three further on: among leaves a pixel says all or nothing, and what four cost is nearly what one costs.
SHARED RowPixels row_pixels(global const float* plane, whole index, truth wide) {
#if W == 1
  const float4 four = FOUR_FROM(plane, index), further = FOUR_FROM(plane, index + 3);
  RowPixels row = {four.x, four.z, four.y, four.w};
  const RowPixels next = {further.x, further.z, further.y, further.w};
#else
  NUMBERS_OF(from, index);
#define FIRST(i, j, k, l) FOUR_FROM(plane, NUMBER(from, i))
#define SECOND(i, j, k, l) FOUR_FROM(plane, NUMBER(from, j))
#define THIRD(i, j, k, l) FOUR_FROM(plane, NUMBER(from, k))
#define FOURTH(i, j, k, l) FOUR_FROM(plane, NUMBER(from, l))
#define ROW \
  by_pixel((real)BY_QUARTERS(FIRST), (real)BY_QUARTERS(SECOND), (real)BY_QUARTERS(THIRD), (real)BY_QUARTERS(FOURTH))
  RowPixels row = ROW;
  plane += 3;
  const RowPixels next = ROW;
#undef ROW
#undef FIRST
#undef SECOND
#undef THIRD
#undef FOURTH
#endif
  row.c = PICK(wide, next.c, row.c);
  row.d = PICK(wide, next.d, row.d);
  return row;
}

/// What the row about a point of the disc shows.
typedef struct {
  real x, y;         // of its first pixel from the fragment, pixels
  RowPixels depths;  // camera z, m; where one pixel stands for the line, that one four times
  truth inside;      // the point is in the image
} Row;

/// (x, y): radii in the image. A row that reaches over a border is moved back into the image. `any_single`: of the
/// lanes.
SHARED Row row_at(global const float* depth, Pixels at, Ball ball, RowDepths depths, int any_single, real x, real y,
                  const ObscuranceSetting* setting) {
  const real u = fma(x, ball.pixels, at.x + REAL(0.5)), v = fma(y, ball.pixels, at.y + REAL(0.5));
  const real end_x = (real)((float)(setting->width)), end_y = (real)((float)(setting->height));
  // Cut off towards zero: `floor` of a vector costs nine instructions.
  const real middle = PICK(depths.wide, REAL(3.0), REAL(1.5)), pixels = PICK(depths.wide, REAL(7.0), REAL(4.0));
  whole pixel_x = TO_WHOLE(at_least(at_most(u - middle, end_x - pixels), REAL(0.0)));
  const whole pixel_y = TO_WHOLE(at_least(at_most(v, end_y - REAL(1.0)), REAL(0.0)));
  const whole line = pixel_y * (whole)(setting->width);
  // Seven pixels are read also where a row is four: from the next row, which counts for nothing, or past the last,
  // where memory goes on (`read_past_end` of host/opencl/buffer.cpp). Only in images narrower than four pixels the
  // start itself may be too late.
  const whole index = min(line + pixel_x, (whole)(max(setting->width * setting->height - 4, 0)));
  Row row;
  row.inside = (u >= REAL(0.0)) & (u < end_x) & (v >= REAL(0.0)) & (v < end_y);
  row.depths = row_pixels(depth, index, depths.wide);
  if (any_single) {
    const whole one_x = TO_WHOLE(at_least(at_most(u, end_x - REAL(1.0)), REAL(0.0)));
    const whole place = line + one_x - index;
    real one = row.depths.a;
    one = PICK(place == (whole)(2), row.depths.b, one);
    one = PICK(place == (whole)(1), row.depths.c, one);
    one = PICK(place == (whole)(3), row.depths.d, one);
    row.depths.a = PICK(depths.single, one, row.depths.a);
    row.depths.b = PICK(depths.single, one, row.depths.b);
    row.depths.c = PICK(depths.single, one, row.depths.c);
    row.depths.d = PICK(depths.single, one, row.depths.d);
    pixel_x = PICK(depths.single, one_x, pixel_x);
  }
  const real first_x = TO_REAL(pixel_x), first_y = TO_REAL(pixel_y);
  row.x = first_x - at.x;
  row.y = first_y - at.y;
  return row;
}

#endif
