// Visibility of everything that stands among grass, the ground included (shared/grass_transmittance.h); 1 above the
// grass and beside it. One work-item per W fragments; planes are padded (host/passes/planes.hpp). -DBELOW: the sky is
// open below the horizon too.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/grass_transmittance.h"
#include "kernels/shared/owner_table.h"

// Where a fragment lies between four columns of nodes: low left, low right, high left, high right.
typedef struct {
  bits column, row;  // of the low left one, always within the grid
  real right, high;  // shares of the right and of the high pair
  truth within;
} Columns;

static inline Columns columns_around(const GrassLayerGrid grid, real x, real y) {
  const real last_column = (real)((float)grid.columns - 1.0f), last_row = (real)((float)grid.rows - 1.0f);
  const real across = fma(x - (real)(grid.low_x), (real)(grid.columns_per_metre), REAL(-0.5));
  const real up = fma(y - (real)(grid.low_y), (real)(grid.rows_per_metre), REAL(-0.5));
  Columns at;
  at.within = (across >= REAL(0.0)) & (across <= last_column) & (up >= REAL(0.0)) & (up <= last_row);
  // The last pair of columns ends the grid: a place on its edge belongs to the pair's right.
  const real column = at_least(at_most(across, last_column), REAL(0.0)),
             row = at_least(at_most(up, last_row), REAL(0.0));
  const real left = at_least(at_most(floor(column), last_column - REAL(1.0)), REAL(0.0));
  const real low = at_least(at_most(floor(row), last_row - REAL(1.0)), REAL(0.0));
  at.column = TO_BITS(left);
  at.row = TO_BITS(low);
  at.right = column - left;
  at.high = row - low;
  return at;
}

// Height of the ground under W fragments, camera-relative m.
static inline real ground_under(const GrassLayerGrid grid, const Columns columns, global const float* ground) {
  uint first[W];
  float right[W], high[W], height[W];
  STORE(columns.row * (bits)(grid.columns) + columns.column, first, 0);
  STORE(columns.right, right, 0);
  STORE(columns.high, high, 0);
  for (uint lane = 0; lane < W; ++lane) {
    const float2 low_pair = vload2(0, ground + first[lane]), high_pair = vload2(0, ground + first[lane] + grid.columns);
    const float2 pair = fma((float2)(high[lane]), high_pair - low_pair, low_pair);
    height[lane] = fma(right[lane], pair.y - pair.x, pair.x);
  }
  return LOAD(height, 0) + (real)(grid.datum);
}

// The lights of W fragments, one after the other: a node and the one above it are one load.
static inline GrassLight light_at(const GrassLayerGrid grid, const Columns columns, real levels,
                                  global const ushort* nodes, global const ushort* below) {
  const real level = at_least(at_most(floor(levels), (real)((float)grid.levels - 2.0f)), REAL(0.0));
  const uint right_node = grid.levels, high_node = grid.columns * grid.levels;  // from the low left one
  uint node[W];
  float right[W], high[W], above[W], light[5][W];
  STORE((columns.row * (bits)(grid.columns) + columns.column) * (bits)(grid.levels) + TO_BITS(level), node, 0);
  STORE(columns.right, right, 0);
  STORE(columns.high, high, 0);
  STORE(levels - level, above, 0);
  for (uint lane = 0; lane < W; ++lane) {
    global const ushort* low_left = nodes + 4 * node[lane];
    global const ushort* high_left = low_left + 4 * high_node;
    const float16 low = convert_float16((ushort16)(vload8(0, low_left), vload8(0, low_left + 4 * right_node)));
    const float16 top = convert_float16((ushort16)(vload8(0, high_left), vload8(0, high_left + 4 * right_node)));
    const float16 four = fma((float16)(high[lane]), top - low, low);
    const float8 pair = fma((float8)(right[lane]), four.hi - four.lo, four.lo);
    const float4 mixed = fma((float4)(above[lane]), pair.hi - pair.lo, pair.lo);
    light[0][lane] = mixed.x;
    light[1][lane] = mixed.y;
    light[2][lane] = mixed.z;
    light[3][lane] = mixed.w;
#ifdef BELOW
    global const ushort* under = below + node[lane];
    const float4 low_below = convert_float4((ushort4)(vload2(0, under), vload2(0, under + right_node)));
    const float4 high_below =
        convert_float4((ushort4)(vload2(0, under + high_node), vload2(0, under + high_node + right_node)));
    const float4 four_below = fma((float4)(high[lane]), high_below - low_below, low_below);
    const float2 pair_below = fma((float2)(right[lane]), four_below.hi - four_below.lo, four_below.lo);
    light[4][lane] = fma(above[lane], pair_below.y - pair_below.x, pair_below.x);
#else
    light[4][lane] = 0;
#endif
  }
  const real low = (real)(grid.low), step = (real)(grid.step);
  GrassLight found;
  found.above = fma(LOAD(light[0], 0), step, low);
  found.zenith = fma(LOAD(light[1], 0), step, low);
  found.x = fma(LOAD(light[2], 0), step, low);
  found.y = fma(LOAD(light[3], 0), step, low);
  found.below = LOAD(light[4], 0) * (real)(grid.below_step);
  return found;
}

kernel void shade_grass_transmittance(global const float* position_x, global const float* position_y,
                                      global const float* position_z, global const float* normal_x,
                                      global const float* normal_y, global const float* normal_z,
                                      const GrassLayerGrid grid, global const float* ground, global const ushort* nodes,
                                      global const ushort* below, uint items, global float* visibility) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  const Columns columns = columns_around(grid, LOAD(position_x, i), LOAD(position_y, i));
  real v = REAL(1.0);
  if (ANY(columns.within)) {
    const real height = LOAD(position_z, i) - ground_under(grid, columns, ground);
    const real top = (real)((float)grid.levels - 1.0f);
    const real levels = height * (real)(grid.levels_per_metre);
    const truth within = columns.within & (levels < top);
    if (ANY(within)) {
      const GrassLight light = light_at(grid, columns, at_least(at_most(levels, top), REAL(0.0)), nodes, below);
      const real a = LOAD(normal_x, i), b = LOAD(normal_y, i), c = LOAD(normal_z, i);
#ifdef BELOW
      v = PICK(within, as_visibility(grass_light(light, a, b, c)), v);
#else
      v = PICK(within, grass_transmittance(light, a, b, c), v);
#endif
    }
  }
  STORE(v, visibility, i);
}
