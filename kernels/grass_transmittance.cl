// Visibility of everything that stands among grass, the ground included (shared/grass_transmittance.h); 1 above the
// grass and beside it. A work-item takes GRASS_GROUPS times W fragments in three steps, all groups' first step before
// any second one: what a step reads depends on what the one before found, and a processor that goes through all three
// with one group mostly waits. Planes are padded (host/passes/planes.hpp). -DBELOW: the sky is open below the horizon.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/fetch_ahead.h"
#include "kernels/shared/four_numbers.h"
#include "kernels/shared/grass_transmittance.h"

// Where a work-item's fragments are among the nodes, by group and lane.
typedef struct {
  // In the table of heights the low left one of the four columns around a fragment; then in the table of nodes that
  // column's node below the fragment.
  uint first[GRASS_GROUPS(W) * W];
  // Shares of the right and of the high pair of columns, and of the nodes above: INFINITY beside the grass or above it.
  float right[GRASS_GROUPS(W) * W], high[GRASS_GROUPS(W) * W], above[GRASS_GROUPS(W) * W];
} GrassPlaces;

static inline void find_columns(const GrassLayerGrid grid, real x, real y, uint group, private GrassPlaces* places) {
  const real last_column = (real)((float)grid.columns - 1.0f), last_row = (real)((float)grid.rows - 1.0f);
  const real across = fma(x - (real)(grid.low_x), (real)(grid.columns_per_metre), REAL(-0.5));
  const real up = fma(y - (real)(grid.low_y), (real)(grid.rows_per_metre), REAL(-0.5));
  const truth within = (across >= REAL(0.0)) & (across <= last_column) & (up >= REAL(0.0)) & (up <= last_row);
  const real column = at_least(at_most(across, last_column), REAL(0.0));
  const real row = at_least(at_most(up, last_row), REAL(0.0));
  // The last pair of columns ends the grid: a place on its edge belongs to the pair's right.
  const whole left = min(TO_WHOLE(column), (whole)((int)grid.columns - 2));
  const whole low = min(TO_WHOLE(row), (whole)((int)grid.rows - 2));
  STORE(TO_BITS(low * (whole)((int)grid.columns) + left) * (bits)(2u), places->first, group);
  STORE(column - TO_REAL(left), places->right, group);
  STORE(row - TO_REAL(low), places->high, group);
  STORE(PICK(within, REAL(0.0), (real)(INFINITY)), places->above, group);
}

// `ground`: of each column and of the one a row higher, m above the datum.
static inline void find_level(const GrassLayerGrid grid, real z, global const float* ground, uint group,
                              private GrassPlaces* places) {
  const real beside = LOAD(places->above, group);
  if (!ANY(beside <= REAL(0.0))) return;
  const FourNumbers corners = four_numbers(ground, places->first + group * W);
  const real right = LOAD(places->right, group), high = LOAD(places->high, group);
  const real left_ground = fma(high, corners.y - corners.x, corners.x);
  const real right_ground = fma(high, corners.w - corners.z, corners.z);
  const real height = z - (fma(right, right_ground - left_ground, left_ground) + (real)(grid.datum));
  const real levels = height * (real)(grid.levels_per_metre) + beside, top = (real)((float)grid.levels - 1.0f);
  const real place = at_least(at_most(levels, top), REAL(0.0));
  const whole level = min(TO_WHOLE(place), (whole)((int)grid.levels - 2));
  STORE(LOAD(places->first, group) * (bits)(2 * grid.levels) + TO_BITS(level) * (bits)(4u), places->first, group);
  STORE(PICK(levels < top, place - TO_REAL(level), (real)(INFINITY)), places->above, group);
}

// Light at the four columns of a node; the level above follows in the table.
typedef struct {
  global const float *low_left, *low_right, *high_left, *high_right;
} GrassColumns;

#if W == 1
static inline FourNumbers light_between(const GrassColumns columns, private const uint* node, real right, real high,
                                        real above) {
#define CELL(corner) EIGHT_AT(columns.corner + node[0])
  const float8 left_light = fma((float8)(high), CELL(high_left) - CELL(low_left), CELL(low_left));
  const float8 right_light = fma((float8)(high), CELL(high_right) - CELL(low_right), CELL(low_right));
  const float8 light = fma((float8)(right), right_light - left_light, left_light);
  const float4 mixed = fma((float4)(above), light.hi - light.lo, light.lo);
  const FourNumbers all = {mixed.x, mixed.y, mixed.z, mixed.w};
  return all;
}
#else
// Of two lanes, the lower level's four numbers and the upper one's each.
static inline float16 between_columns(const GrassColumns columns, uint first, uint second, float16 right,
                                      float16 high) {
#define CELLS(corner) ((float16)(EIGHT_AT(columns.corner + first), EIGHT_AT(columns.corner + second)))
  const float16 low_left = CELLS(low_left), left = fma(high, CELLS(high_left) - low_left, low_left);
  const float16 low_right = CELLS(low_right), right_light = fma(high, CELLS(high_right) - low_right, low_right);
  return fma(right, right_light - left, left);
}

// Of two pairs of lanes.
static inline float16 between_levels(float16 first, float16 second, float16 above) {
  const float16 lower = (float16)(first.s0123, first.s89ab, second.s0123, second.s89ab);
  const float16 upper = (float16)(first.s4567, first.scdef, second.s4567, second.scdef);
  return fma(above, upper - lower, lower);
}

static inline FourNumbers light_between(const GrassColumns columns, private const uint* node, real right, real high,
                                        real above) {
#define TWO(v, a, b) (v).s##a##a##a##a##a##a##a##a##b##b##b##b##b##b##b##b
#define PAIR(a, b) between_columns(columns, node[0x##a], node[0x##b], TWO(right, a, b), TWO(high, a, b))
#define LIGHT_ROW(a, b, c, d) \
  between_levels(PAIR(a, b), PAIR(c, d), above.s##a##a##a##a##b##b##b##b##c##c##c##c##d##d##d##d)
  return BY_FOURS(LIGHT_ROW);
}
#endif

#ifdef BELOW
// The light from below. `below`: of each node, of the one above it, and of these two a row higher.
static inline real below_between(const GrassLayerGrid grid, global const float* below, private const uint* node,
                                 real right, real high, real above) {
  const FourNumbers left = four_numbers(below, node), next = four_numbers(below + 4 * grid.levels, node);
  const real left_lower = fma(high, left.z - left.x, left.x), left_upper = fma(high, left.w - left.y, left.y);
  const real right_lower = fma(high, next.z - next.x, next.x), right_upper = fma(high, next.w - next.y, next.y);
  const real lower = fma(right, right_lower - left_lower, left_lower);
  const real upper = fma(right, right_upper - left_upper, left_upper);
  return fma(above, upper - lower, lower);
}
#endif

kernel void shade_grass_transmittance(global const float* position_x, global const float* position_y,
                                      global const float* position_z, global const float* normal_x,
                                      global const float* normal_y, global const float* normal_z,
                                      const GrassLayerGrid grid, global const float* ground, global const float* nodes,
                                      global const float* below, uint items, global float* visibility) {
  const uint item = get_global_id(0);
  if (item >= items) return;
  const uint first = item * GRASS_GROUPS(W);
  GrassPlaces places;
  for (uint group = 0; group < GRASS_GROUPS(W); ++group) {
    const uint i = first + group;
    fetch_planes(position_x, position_y, position_z, i);
    fetch_planes(normal_x, normal_y, normal_z, i);
    find_columns(grid, LOAD(position_x, i), LOAD(position_y, i), group, &places);
  }
  for (uint group = 0; group < GRASS_GROUPS(W); ++group)
    find_level(grid, LOAD(position_z, first + group), ground, group, &places);
  const uint right_node = 4 * grid.levels, high_node = right_node * grid.columns;
  const GrassColumns columns = {nodes, nodes + right_node, nodes + high_node, nodes + right_node + high_node};
  for (uint group = 0; group < GRASS_GROUPS(W); ++group) {
    const uint i = first + group;
    const real above = LOAD(places.above, group);
    const truth within = above <= REAL(1.0);
    real v = REAL(1.0);
    if (ANY(within)) {
      const real right = LOAD(places.right, group), high = LOAD(places.high, group);
      const FourNumbers found = light_between(columns, places.first + group * W, right, high, above);
      GrassLight light = {found.x, found.y, found.z, found.w, REAL(0.0)};
      const real a = LOAD(normal_x, i), b = LOAD(normal_y, i), c = LOAD(normal_z, i);
#ifdef BELOW
      light.below = below_between(grid, below, places.first + group * W, right, high, above);
      v = PICK(within, as_visibility(grass_light(light, a, b, c)), v);
#else
      v = PICK(within, grass_transmittance(light, a, b, c), v);
#endif
    }
    STORE(v, visibility, i);
  }
}
