// Bends every blade of one field in the wind of time t and writes its 7 vertices. One work-item per W blades, one
// work-group per 256: vertex k of lane l goes to 7 * 256 * group + 256 k + l, so that stores and triangle corners are
// contiguous (triangle_corners.h).
// With -DTHINNED only the blades of a list of units are posed, wider than at rest, and far ones as strips of 5 or 3
// vertices whose area is that of the whole blade.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/fetch_ahead.h"
#include "kernels/shared/grass_bend.h"
#include "kernels/shared/pose_blade.h"
#include "kernels/shared/posed_vertices.h"
#include "kernels/shared/records.h"
#include "kernels/shared/sway_pairs.h"
#include "kernels/shared/triangle_corners.h"

#define LARGEST_BEND_SQUARED 6.25f  // of 2.5 radians: as far as arc.h is proven

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

static inline PosedRecords blade_way(BladePoint point) {
  const PosedLanes lanes = {point.x, point.y, point.z};
  return posed_records(lanes);
}

// Two vertices, `share` of `across` to the left and to the right of the midline.
static inline void store_pair(global float4* posed, uint vertex, PosedRecords middle, float share,
                              PosedRecords across) {
  store_records(moved_by(middle, -share, across), posed, vertex);
  store_records(moved_by(middle, share, across), posed, vertex + CHUNK);
}

#ifdef THINNED
// `pairs` 2: pairs of vertices at 0 and 0.6 of the length, and the tip; 1: base and tip. Widths keep the area of the
// full strip, 0.66875 of length times base width.
static inline void store_short_strip(global float4* posed, uint vertex, uint pairs, real size, GrassBend bend,
                                     PosedRecords root, PosedRecords across) {
  store_pair(posed, vertex, root, pairs == 1 ? 1.3375f : 1.0f, across);
  if (pairs == 2) {
    const PosedRecords middle = moved_by(root, 1.0f, blade_way(blade_midline(size, bend.x, bend.y, REAL(0.6))));
    store_pair(posed, vertex + 2 * CHUNK, middle, 0.7375f, across);
    vertex += 2 * CHUNK;
  }
  const PosedRecords tip = blade_way(blade_midline(size, bend.x, bend.y, REAL(1.0)));
  store_records(moved_by(root, 1.0f, tip), posed, vertex + 2 * CHUNK);
}
#endif

kernel void pose_grass(global const float* root_x, global const float* root_y, global const float* root_z,
                       global const float* length, global const float* half_width, global const float* rest_x,
                       global const float* rest_y, global const float* facing_x, global const float* facing_y,
                       global const float* flexibility, global const float* phase, const GrassWind wind,
                       global const float2* series,
#ifdef THINNED
                       global const BladeUnit* units, uint first_unit, uint items,
#else
                       uint first_blade, uint first_vertex,
#endif
                       global float4* posed) {
#ifdef THINNED
  if (get_global_id(0) >= items) return;
  const uint place = get_global_id(0) * W;
  global const BladeUnit* unit = units + first_unit + place / 16;
  const size_t blade = (unit->first_blade + place % 16) / W;
  const uint vertex = unit->first_vertex + place % 16;
  const real widening = (real)(unit->width);
#else
  const size_t blade = first_blade / W + get_global_id(0);
  const uint lane = get_global_id(0) * W;  // whatever size of work-group the device grants
  const uint vertex = first_vertex + 7 * CHUNK * (lane / CHUNK) + lane % CHUNK;
#endif
  fetch_planes(root_x, root_y, root_z, blade);
  fetch_planes(length, half_width, facing_x, blade);
  fetch_planes(facing_y, rest_x, rest_y, blade);
  fetch_plane(flexibility, blade);
  fetch_plane(phase, blade);
  const uint mask = wind.series_count - 1;
  const real half_period = (real)((float)(wind.series_count / 2));

  const real rx = LOAD(root_x, blade), ry = LOAD(root_y, blade);
  const GrassGust gust = grass_gust(wind, rx, ry);
  const Sway early = look_up(series, mask, gust.sample), late = look_up(series, mask, gust.sample + half_period);
  const real along_gust = fma(gust.first_share, early.along, gust.second_share * late.along);
  const real across_gust = fma(gust.first_share, early.across, gust.second_share * late.across);
  GrassBend bend = grass_bend(wind, along_gust, across_gust, LOAD(rest_x, blade), LOAD(rest_y, blade),
                              LOAD(flexibility, blade), LOAD(phase, blade));
  const real square = fma(bend.x, bend.x, bend.y * bend.y);
  const truth too_far = square > (real)(LARGEST_BEND_SQUARED);
  if (ANY(too_far)) {
    const real limited = PICK(too_far, sqrt((real)(LARGEST_BEND_SQUARED) / square), REAL(1.0));
    bend.x *= limited;
    bend.y *= limited;
  }

  const real size = LOAD(length, blade);
  const PosedLanes foot = {rx + (real)(wind.root_offset_x), ry + (real)(wind.root_offset_y),
                           LOAD(root_z, blade) + (real)(wind.root_offset_z)};
#ifdef THINNED
  const real reach = LOAD(half_width, blade) * widening;
#else
  const real reach = LOAD(half_width, blade);
#endif
  const PosedLanes side = {LOAD(facing_x, blade) * reach, LOAD(facing_y, blade) * reach, REAL(0.0)};
  const PosedRecords root = posed_records(foot), across = posed_records(side);
#ifdef THINNED
  if (unit->pairs < 3) {
    store_short_strip(posed, vertex, unit->pairs, size, bend, root, across);
    return;
  }
#endif
  const PosedRecords middle = moved_by(root, 1.0f, blade_way(blade_midline(size, bend.x, bend.y, REAL(0.4))));
  const PosedRecords upper = moved_by(root, 1.0f, blade_way(blade_midline(size, bend.x, bend.y, REAL(0.75))));
  const PosedRecords tip = moved_by(root, 1.0f, blade_way(blade_midline(size, bend.x, bend.y, REAL(1.0))));
  store_pair(posed, vertex, root, 1.0f, across);
  store_pair(posed, vertex + 2 * CHUNK, middle, 0.85f, across);
  store_pair(posed, vertex + 4 * CHUNK, upper, 0.5f, across);
  store_records(tip, posed, vertex + 6 * CHUNK);
}
