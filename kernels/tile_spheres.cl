// Sorts the spheres for every tile of fragments (shared/fragment_tiles.h): distant ones are folded into the tile's far
// occlusion while that costs little accuracy, all others are listed by their distance for solid_angle.cl. Each fold
// changes V by at most `each`, all of a tile together by at most `budget`. One work-item per tile; built with W = 16
// (16 fragments, then 16 spheres, at a time) and -DSHARE as solid_angle.cl.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/fetch_ahead.h"
#include "kernels/shared/tile_spheres.h"

kernel void list_tile_spheres(global const float* position_x, global const float* position_y,
                              global const float* position_z, global const uint* owner, global const uint* validity,
                              global const int* owner_group, uint owners, global const ShadingSphere* spheres,
                              uint sphere_count, float each, float budget, uint row_length, uint units, uint tile_total,
                              global TileOcclusion* tiles, global uint2* lists, uint slots) {
  const uint tile = get_global_id(0);
  if (tile >= tile_total) return;
  const uint column = tile % tile_columns(row_length), top = tile / tile_columns(row_length) * TILE_ROWS;
  TileBounds bounds = no_bounds();
  for (uint row = top; row < top + TILE_ROWS; ++row) {
    const uint begin = first_unit(row, row_length) + column * TILE_UNITS;
    const uint end = min(min(begin + TILE_UNITS, first_unit(row + 1, row_length)), units);
    const uint below = first_unit(row + 1, row_length) + column * TILE_UNITS;
    for (uint unit = below; unit < min(below + TILE_UNITS, units) && row + 1 < top + TILE_ROWS; ++unit) {
      fetch_ahead(position_x + unit * UNIT);
      fetch_ahead(position_y + unit * UNIT);
      fetch_ahead(position_z + unit * UNIT);
      fetch_ahead(owner + unit * UNIT);
      fetch_ahead(validity + unit * UNIT);
    }
    for (uint unit = begin; unit < end; ++unit) {
      const real x = LOAD(position_x, unit), y = LOAD(position_y, unit), z = LOAD(position_z, unit);
      const truth drawn = ((LOAD(validity, unit) & (bits)(VALIDITY_BACKGROUND)) == (bits)(0u)) & in_reach(x, y, z);
      if (!ANY(drawn)) continue;
      include(&bounds.x, x, drawn);
      include(&bounds.y, y, drawn);
      include(&bounds.z, z, drawn);
      bounds.groups |= groups_of(signed_owner_column(owner_group, owner_row(LOAD(owner, unit), owners)), drawn);
    }
  }
  const TileView view = view_of(bounds);

  FarField field = no_field();
  SphereLists counts = {0, 0, 0, 0};
  global uint2* list = lists + tile * (LISTS * slots);
  for (uint first = 0; first < sphere_count && view.drawn; first += W) {
    if (max(counts.distant, max(counts.close, counts.near)) + W > slots) {  // no room
      const SphereLists all = {0, 0, ALL_SPHERES, 1};
      tiles[tile] = tile_occlusion(no_field(), all);
      return;
    }
    const SphereLanes lanes = load_spheres(spheres, first, sphere_count);
    const SphereBounds reach = bound_spheres(view, lanes);
    const truth folded = choose_folded(reach, each, budget, &field);
    fold(view, lanes, folded, &field);
    counts.distant = append(list, counts.distant, first, lanes.radius, reach.distant & NOT(folded));
    counts.close = append(list + slots, counts.close, first, lanes.radius, reach.close);
    counts.near = append(list + 2 * slots, counts.near, first, lanes.radius, reach.near);
    if (ANY(reach.own)) counts.own = 1;
  }
  tiles[tile] = tile_occlusion(field, counts);
}
