// Bends every blade of one field in the wind of time t and writes its 7 vertices. One work-item per W blades, one
// work-group per 256: vertex k of lane l goes to 7 * 256 * group + 256 k + l, so that stores and triangle corners are
// contiguous (triangle_corners.h).
// With -DTHINNED only the blades of a list of units are posed, wider than at rest, and far ones as strips of 5 or 3
// vertices whose area is that of the whole blade.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/grass_bend.h"
#include "kernels/shared/pose_blade.h"
#include "kernels/shared/posed_vertices.h"
#include "kernels/shared/records.h"
#include "kernels/shared/triangle_corners.h"

#define LARGEST_BEND 2.5f  // radians: where arc.h is proven

// Component 0 (along) or 1 (across) of the sway series, interleaved; linear interpolation, periodic.
static inline real look_up(global const float* series, uint mask, real sample, uint component) {
  const real before = rint(sample - REAL(0.5)), part = sample - before;
  const whole i = TO_WHOLE(before), last = (whole)((int)mask), at = (whole)((int)component);
  const whole first = 2 * (i & last) + at, next = 2 * ((i + 1) & last) + at;
  const real low = GATHER(real, series, first, ), high = GATHER(real, series, next, );
  return fma(part, high - low, low);
}

static inline void store_point(global float4* posed, uint vertex, real px, real py, real pz) {
  const PosedLanes lanes = {px, py, pz};
  store_posed(lanes, posed, vertex);
}

#ifdef THINNED
// `pairs` 2: pairs of vertices at 0 and 0.6 of the length, and the tip; 1: base and tip. Widths keep the area of the
// full strip, 0.66875 of length times base width.
static inline void store_short_strip(global float4* posed, uint vertex, uint pairs, real size, GrassBend bend,
                                     BladePoint root, real wx, real wy) {
  const BladePoint tip = blade_midline(size, bend.x, bend.y, REAL(1.0));
  const real base = pairs == 1 ? REAL(1.3375) : REAL(1.0);
  store_point(posed, vertex, root.x - base * wx, root.y - base * wy, root.z);
  store_point(posed, vertex + CHUNK, root.x + base * wx, root.y + base * wy, root.z);
  if (pairs == 2) {
    const BladePoint middle = blade_midline(size, bend.x, bend.y, REAL(0.6));
    const real x = root.x + middle.x, y = root.y + middle.y, z = root.z + middle.z;
    const real mx = REAL(0.7375) * wx, my = REAL(0.7375) * wy;
    store_point(posed, vertex + 2 * CHUNK, x - mx, y - my, z);
    store_point(posed, vertex + 3 * CHUNK, x + mx, y + my, z);
    vertex += 2 * CHUNK;
  }
  store_point(posed, vertex + 2 * CHUNK, root.x + tip.x, root.y + tip.y, root.z + tip.z);
}
#endif

kernel void pose_grass(global const float* root_x, global const float* root_y, global const float* root_z,
                       global const float* length, global const float* half_width, global const float* rest_x,
                       global const float* rest_y, global const float* facing_x, global const float* facing_y,
                       global const float* flexibility, global const float* phase, const GrassWind wind,
                       global const float* series, 
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
  const uint mask = wind.series_count - 1;
  const real half_period = (real)((float)(wind.series_count / 2));

  const real rx = LOAD(root_x, blade), ry = LOAD(root_y, blade);
  const GrassGust gust = grass_gust(wind, rx, ry);
  const real along_gust = gust.first_share * look_up(series, mask, gust.sample, 0) +
                          gust.second_share * look_up(series, mask, gust.sample + half_period, 0);
  const real across_gust = gust.first_share * look_up(series, mask, gust.sample, 1) +
                           gust.second_share * look_up(series, mask, gust.sample + half_period, 1);
  GrassBend bend = grass_bend(wind, along_gust, across_gust, LOAD(rest_x, blade), LOAD(rest_y, blade),
                              LOAD(flexibility, blade), LOAD(phase, blade));
  const real angle = sqrt(bend.x * bend.x + bend.y * bend.y), largest = (real)(LARGEST_BEND);
  const real limited = largest / max(angle, largest);
  bend.x *= limited;
  bend.y *= limited;

  const real ox = rx + (real)(wind.root_offset_x), oy = ry + (real)(wind.root_offset_y),
             oz = LOAD(root_z, blade) + (real)(wind.root_offset_z), size = LOAD(length, blade);
#ifdef THINNED
  const real reach = LOAD(half_width, blade) * widening;
  if (unit->pairs < 3) {
    store_short_strip(posed, vertex, unit->pairs, size, bend, (BladePoint){ox, oy, oz}, LOAD(facing_x, blade) * reach,
                      LOAD(facing_y, blade) * reach);
    return;
  }
#else
  const real reach = LOAD(half_width, blade);
#endif
  const real wx = LOAD(facing_x, blade) * reach, wy = LOAD(facing_y, blade) * reach;
  const BladePoint middle = blade_midline(size, bend.x, bend.y, REAL(0.4));
  const BladePoint upper = blade_midline(size, bend.x, bend.y, REAL(0.75));
  const BladePoint tip = blade_midline(size, bend.x, bend.y, REAL(1.0));
  const real mx = REAL(0.85) * wx, my = REAL(0.85) * wy, ux = REAL(0.5) * wx, uy = REAL(0.5) * wy;

  store_point(posed, vertex, ox - wx, oy - wy, oz);
  store_point(posed, vertex + CHUNK, ox + wx, oy + wy, oz);
  store_point(posed, vertex + 2 * CHUNK, ox + middle.x - mx, oy + middle.y - my, oz + middle.z);
  store_point(posed, vertex + 3 * CHUNK, ox + middle.x + mx, oy + middle.y + my, oz + middle.z);
  store_point(posed, vertex + 4 * CHUNK, ox + upper.x - ux, oy + upper.y - uy, oz + upper.z);
  store_point(posed, vertex + 5 * CHUNK, ox + upper.x + ux, oy + upper.y + uy, oz + upper.z);
  store_point(posed, vertex + 6 * CHUNK, ox + tip.x, oy + tip.y, oz + tip.z);
}
