// Visibility of everything that stands among grass, the ground included (shared/grass_transmittance.h); 1 above the
// grass and beside it. One work-item per W fragments; planes are padded (host/passes/planes.hpp). -DBELOW: the sky is
// open below the horizon too.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/grass_transmittance.h"
#include "kernels/shared/owner_table.h"

// Where a fragment lies between four columns. Corners: low left, low right, high left, high right.
typedef struct {
  bits corner[4];  // column numbers, always within the grid
  real share[4];   // bilinear weights
  truth within;
} Columns;

static inline Columns columns_around(const GrassLayerGrid grid, real x, real y) {
  const real last_column = (real)((float)grid.columns - 1.0f), last_row = (real)((float)grid.rows - 1.0f);
  const real across = fma(x - (real)(grid.low_x), (real)(grid.columns_per_metre), REAL(-0.5));
  const real up = fma(y - (real)(grid.low_y), (real)(grid.rows_per_metre), REAL(-0.5));
  Columns at;
  at.within = (across >= REAL(0.0)) & (across <= last_column) & (up >= REAL(0.0)) & (up <= last_row);
  // The last pair of columns ends the grid: a place on its edge belongs to the pair's right.
  const real column = at_least(at_most(across, last_column), REAL(0.0)), row = at_least(at_most(up, last_row), REAL(0.0));
  const real left = at_least(at_most(floor(column), last_column - REAL(1.0)), REAL(0.0));
  const real low = at_least(at_most(floor(row), last_row - REAL(1.0)), REAL(0.0));
  const real fx = column - left, fy = row - low;
  const bits first = TO_BITS(low) * (bits)(grid.columns) + TO_BITS(left);
  at.corner[0] = first;
  at.corner[1] = first + (bits)(1u);
  at.corner[2] = first + (bits)(grid.columns);
  at.corner[3] = first + (bits)(grid.columns + 1u);
  const real both = fx * fy;
  at.share[0] = REAL(1.0) - fx - fy + both;
  at.share[1] = fx - both;
  at.share[2] = fy - both;
  at.share[3] = both;
  return at;
}

// The lights of W fragments, one after the other: a node and the one above it are one load.
static inline GrassLight light_at(const GrassLayerGrid grid, const Columns columns, real levels,
                                  global const ushort* nodes, global const ushort* below) {
  const real level = at_least(at_most(floor(levels), (real)((float)grid.levels - 2.0f)), REAL(0.0));
  const real up = levels - level;
  const bits first_level = TO_BITS(level);
 private
  uint node[4][W];
 private
  float share[4][W], above_share[W], light[5][W];
  for (int k = 0; k < 4; ++k) {
    STORE(columns.corner[k] * (bits)(grid.levels) + first_level, node[k], 0);
    STORE(columns.share[k], share[k], 0);
  }
  STORE(up, above_share, 0);
  for (uint lane = 0; lane < W; ++lane) {
    float8 pair = (float8)(0.0f);
    float2 low_pair = (float2)(0.0f);
    for (int k = 0; k < 4; ++k) {
      pair = fma(convert_float8(vload8(0, nodes + 4 * node[k][lane])), (float8)(share[k][lane]), pair);
#ifdef BELOW
      low_pair = fma(convert_float2(vload2(0, below + node[k][lane])), (float2)(share[k][lane]), low_pair);
#endif
    }
    const float4 mixed = fma(pair.hi - pair.lo, (float4)(above_share[lane]), pair.lo);
    light[0][lane] = mixed.x;
    light[1][lane] = mixed.y;
    light[2][lane] = mixed.z;
    light[3][lane] = mixed.w;
    light[4][lane] = fma(low_pair.y - low_pair.x, above_share[lane], low_pair.x);
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

// Height of the ground under W fragments, camera-relative m.
static inline real ground_under(const GrassLayerGrid grid, const Columns columns, global const float* ground) {
  real z = (real)(grid.datum);
  for (int k = 0; k < 4; ++k) z = fma(columns.share[k], GATHER(real, ground, columns.corner[k], ), z);
  return z;
}

kernel void shade_grass_transmittance(global const float* position_x, global const float* position_y,
                                      global const float* position_z, global const float* normal_x,
                                      global const float* normal_y, global const float* normal_z,
                                      const GrassLayerGrid grid, global const float* ground,
                                      global const ushort* nodes, global const ushort* below, uint items,
                                      global float* visibility) {
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
      const GrassLight light =
          light_at(grid, columns, at_least(at_most(levels, top), REAL(0.0)), nodes, below);
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
