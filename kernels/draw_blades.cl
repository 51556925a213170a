// Bends the blades of a list of units in the wind of time t and draws them at once: every vertex is projected where it
// is posed, and written for what the resolve will see of it. Blades are wider than at rest, and far ones strips of 5 or
// 3 vertices instead of 7, with the area of the whole blade. One work-item per W blades of a unit.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/bent_blades.h"
#include "kernels/shared/draw_lanes.h"

// Shares of the length where a strip of 1, 2, 3 pairs of vertices and a tip has its pairs, and how wide it is there:
// the shorter ones have the area of the longest, 0.66875 of length times base width.
constant float pair_at[3][3] = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.6f, 0.0f}, {0.0f, 0.4f, 0.75f}};
constant float pair_width[3][3] = {{1.3375f, 0.0f, 0.0f}, {1.0f, 0.7375f, 0.0f}, {1.0f, 0.85f, 0.5f}};

static inline PosedLanes moved_lanes(PosedLanes from, float share, PosedLanes way) {
  PosedLanes to;
  to.x = fma((real)(share), way.x, from.x);
  to.y = fma((real)(share), way.y, from.y);
  to.z = fma((real)(share), way.z, from.z);
  return to;
}

static inline PosedLanes middle_at(const BentBlades* blades, float share) {
  if (share == 0.0f) return blades->foot;
  const BladePoint point = on_midline(blades, share);
  const PosedLanes way = {point.x, point.y, point.z};
  return moved_lanes(blades->foot, 1.0f, way);
}

// A triangle on its base has a third of its length as its mean height above the root, the whole blade 0.3833 of it: 3
// of 16 blades stand on their tips. `first`: of the unit's lanes.
static inline PosedLanes some_upside_down(PosedLanes middle, PosedLanes other, uint first) {
  const truth turned = (LANE_NUMBERS + (whole)((int)first)) % 5 == 2;
  PosedLanes to;
  to.x = PICK(turned, other.x, middle.x);
  to.y = PICK(turned, other.y, middle.y);
  to.z = PICK(turned, other.z, middle.z);
  return to;
}

kernel void draw_blades(REST_BLADES, const GrassWind wind, global const float2* series, global const BladeUnit* units,
                        uint first_unit, uint items, global const TriangleChunk* chunks, const CameraView camera,
                        global float4* posed, global VisibleTriangle* pixels) {
  if (get_global_id(0) >= items) return;
  const uint place = get_global_id(0) * W;
  const BladeUnit unit = units[first_unit + place / 16];
  const uint triangle = unit.first_triangle + place % 16, lane = triangle % CHUNK;
  global const TriangleChunk* chunk = chunks + triangle / CHUNK;
  const uint later = place + UNITS_AHEAD * 16;
  if (later < items * W) {
    const uint next_triangle = units[first_unit + later / 16].first_triangle + later % 16;
    fetch_blades(REST_BLADE_NAMES, (chunks[next_triangle / CHUNK].first_index + next_triangle % CHUNK) / W);
  }
  const BentBlades blades = bent_blades(REST_BLADE_NAMES, wind, series, (chunk->first_index + lane) / W, unit.width);
  const uint count = 2 * unit.pairs + 1;
  PosedLanes strip[7], middle = blades.foot;
  uint clipped[5];
  const ProjectedCorners none = {REAL(0.0), REAL(0.0), REAL(0.0), REAL(0.0)};
  ProjectedCorners before = none, last = none, next = none;  // the strip's last three vertices
  for (uint k = 0; k < count; ++k) {
    const uint pair = k / 2;
    const int is_tip = k == count - 1;
    if (k % 2 == 0) {
      middle = middle_at(&blades, is_tip ? 1.0f : pair_at[unit.pairs - 1][pair]);
      if (unit.pairs == 1) middle = some_upside_down(middle, middle_at(&blades, is_tip ? 0.0f : 1.0f), place % 16);
    }
    const float width = is_tip ? 0.0f : pair_width[unit.pairs - 1][pair];
    strip[k] = moved_lanes(middle, k % 2 == 0 ? -width : width, blades.across);
    before = last;
    last = next;
    next = project_corners(&camera, strip[k]);
    if (k >= 2)
      clipped[k - 2] = lane_bits(draw_unclipped(&camera, before, last, next, triangle + (k - 2) * CHUNK, pixels));
  }
  // Atomics wait for the stores before them: these have the bending of the next blades to get to memory.
  for (uint k = 0; k < count; ++k)
    store_records(posed_records(strip[k]), posed, chunk->first_vertex + k * CHUNK + lane);
  for (uint k = 0; k + 2 < count; ++k)
    for (uint left = clipped[k]; left != 0;) {
      const uint i = next_lane(&left);
      clip_and_scan_convert(&camera, grass_corners(chunk + k, lane + i), posed, triangle + k * CHUNK + i, pixels);
    }
}
