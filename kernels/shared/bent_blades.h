// W blades of one field in the wind of time t: where they stand, how they bend and how wide they are. OpenCL only.
#ifndef UNDERSTORY_BENT_BLADES_H
#define UNDERSTORY_BENT_BLADES_H

#include "kernels/shared/fetch_ahead.h"
#include "kernels/shared/grass_bend.h"
#include "kernels/shared/pose_blade.h"
#include "kernels/shared/posed_vertices.h"
#include "kernels/shared/records.h"
#include "kernels/shared/sway_pairs.h"

#define LARGEST_BEND_SQUARED 6.25f  // of 2.5 radians: as far as arc.h is proven

// The planes of RestBlades (host/passes/geometry.hpp).
#define REST_BLADES                                                                                               \
  global const float *root_x, global const float *root_y, global const float *root_z, global const float *length, \
      global const float *half_width, global const float *rest_x, global const float *rest_y,                     \
      global const float *facing_x, global const float *facing_y, global const float *flexibility,                \
      global const float *phase

#define REST_BLADE_NAMES \
  root_x, root_y, root_z, length, half_width, rest_x, rest_y, facing_x, facing_y, flexibility, phase

typedef struct {
  PosedLanes foot, across;  // camera-relative m; from the midline to the right edge at the foot
  real length;              // m
  GrassBend bend;
} BentBlades;

// Of the sway series, radians at flexibility 1.
typedef struct {
  real along, across;
} Sway;

// Linear interpolation, periodic.
static inline Sway look_up(global const float2* series, uint mask, real sample) {
  const real before = rounded(sample - REAL(0.5)), part = sample - before;
  const whole at = TO_WHOLE(before), last = (whole)((int)mask), first = at & last, next = (at + 1) & last;
  const SwayPairs low = gather_pairs(series, first, next);
  const Sway sway = {fma(part, low.next_along - low.along, low.along),
                     fma(part, low.next_across - low.across, low.across)};
  return sway;
}

// Asks for what W blades will read, `blade` as below.
static inline void fetch_blades(REST_BLADES, size_t blade) {
  fetch_ahead(root_x + blade * W);
  fetch_ahead(root_y + blade * W);
  fetch_ahead(root_z + blade * W);
  fetch_ahead(length + blade * W);
  fetch_ahead(half_width + blade * W);
  fetch_ahead(rest_x + blade * W);
  fetch_ahead(rest_y + blade * W);
  fetch_ahead(facing_x + blade * W);
  fetch_ahead(facing_y + blade * W);
  fetch_ahead(flexibility + blade * W);
  fetch_ahead(phase + blade * W);
}

// `blade`: which W of the planes. `widening`: how much wider they are than at rest.
static inline BentBlades bent_blades(REST_BLADES, const GrassWind wind, global const float2* series, size_t blade,
                                     float widening) {
  const uint mask = wind.series_count - 1;
  const real half_period = (real)((float)(wind.series_count / 2));

  const real rx = LOAD(root_x, blade), ry = LOAD(root_y, blade);
  const GrassGust gust = grass_gust(wind, rx, ry);
  const Sway early = look_up(series, mask, gust.sample), late = look_up(series, mask, gust.sample + half_period);
  const real along_gust = fma(gust.first_share, early.along, gust.second_share * late.along);
  const real across_gust = fma(gust.first_share, early.across, gust.second_share * late.across);
  BentBlades blades;
  blades.bend = grass_bend(wind, along_gust, across_gust, LOAD(rest_x, blade), LOAD(rest_y, blade),
                           LOAD(flexibility, blade), LOAD(phase, blade));
  const real square = fma(blades.bend.x, blades.bend.x, blades.bend.y * blades.bend.y);
  const truth too_far = square > (real)(LARGEST_BEND_SQUARED);
  if (ANY(too_far)) {
    const real limited = PICK(too_far, sqrt((real)(LARGEST_BEND_SQUARED) / square), REAL(1.0));
    blades.bend.x *= limited;
    blades.bend.y *= limited;
  }
  blades.foot.x = rx + (real)(wind.root_offset_x);
  blades.foot.y = ry + (real)(wind.root_offset_y);
  blades.foot.z = LOAD(root_z, blade) + (real)(wind.root_offset_z);
  const real reach = LOAD(half_width, blade) * (real)(widening);
  blades.across.x = LOAD(facing_x, blade) * reach;
  blades.across.y = LOAD(facing_y, blade) * reach;
  blades.across.z = REAL(0.0);
  blades.length = LOAD(length, blade);
  return blades;
}

static inline BladePoint on_midline(const BentBlades* blades, float share) {
  return blade_midline(blades->length, blades->bend.x, blades->bend.y, (real)(share));
}

#endif
