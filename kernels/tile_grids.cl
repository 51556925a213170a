// Lists for every tile of fragments (shared/fragment_tiles.h) the occlusion grids that some of its fragments may lie in:
// by what the tile covers in the scene, so that a body out of view still shades what is in view. In order of the grids.
// One work-item per tile; W = 16: 16 fragments, then 16 grids, at a time.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/fragment_tiles.h"
#include "kernels/shared/grid_record.h"
#include "kernels/shared/shading_sphere.h"
#include "kernels/shared/tile_bounds.h"
#include "kernels/shared/tile_grids.h"
#include "kernels/shared/validity.h"

/// The tile's box, taken into the grid's frame, meets the grid's box.
SHARED int box_meets_grid(global const GridRecord* grid, const float low[3], const float high[3]) {
  int meets = 1;
  for (int row = 0; row < 3; ++row) {
    float middle = grid->to_box[4 * row + 3], reach = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
      const float factor = grid->to_box[4 * row + axis];
      middle = fma(factor, 0.5f * (low[axis] + high[axis]), middle);
      reach = fma(fabs(factor), 0.5f * (high[axis] - low[axis]), reach);
    }
    // Rounding keeps a fragment on the border in.
    meets &= fabs(middle) <= fma(reach, 1.0001f, 1.0001f);
  }
  return meets;
}

/// `bounds`: the boxes of the grids, camera-relative m: planes low x, y, z, high x, y, z of `padded` numbers each.
kernel void list_tile_grids(global const float* position_x, global const float* position_y,
                            global const float* position_z, global const uint* validity,
                            global const GridRecord* grids, uint grid_count, global const float* bounds, uint padded,
                            uint row_length, uint units, uint tile_total, global uint* listed, global uint* lists,
                            uint capacity) {
  const uint tile = get_global_id(0);
  if (tile >= tile_total) return;
  const uint column = tile % tile_columns(row_length), top = tile / tile_columns(row_length) * TILE_ROWS;
  TileBounds box = no_bounds();
  for (uint row = top; row < top + TILE_ROWS; ++row) {
    const uint begin = first_unit(row, row_length) + column * TILE_UNITS;
    const uint end = min(min(begin + TILE_UNITS, first_unit(row + 1, row_length)), units);
    for (uint unit = begin; unit < end; ++unit) {
      const real x = LOAD(position_x, unit), y = LOAD(position_y, unit), z = LOAD(position_z, unit);
      const truth drawn = ((LOAD(validity, unit) & (bits)(VALIDITY_BACKGROUND)) == (bits)(0u)) & in_reach(x, y, z);
      include(&box.x, x, drawn);
      include(&box.y, y, drawn);
      include(&box.z, z, drawn);
    }
  }
  const float low[3] = {lowest(box.x.low), lowest(box.y.low), lowest(box.z.low)};
  const float high[3] = {highest(box.x.high), highest(box.y.high), highest(box.z.high)};

  uint count = 0;
  for (uint first = 0; first < grid_count && low[0] <= high[0]; first += W) {
    truth meets = (truth)(-1);
    for (uint axis = 0; axis < 3; ++axis)
      meets &= (LOAD(bounds + axis * padded, first / W) <= (real)(high[axis])) &
               (LOAD(bounds + (axis + 3) * padded, first / W) >= (real)(low[axis]));
    if (!ANY(meets)) continue;
    int kept[W];
    STORE(meets, kept, 0);
    for (uint lane = 0; lane < W && first + lane < grid_count; ++lane)
      if (kept[lane] && box_meets_grid(grids + first + lane, low, high)) {
        if (count < capacity) lists[tile * capacity + count] = first + lane;
        ++count;
      }
  }
  listed[tile] = count <= capacity ? count : ALL_GRIDS;
}
