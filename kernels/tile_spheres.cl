// Sorts the spheres for every tile of 16 x 16 fragments (shared/fragment_tiles.h): those that no fragment of the tile can
// see are left out, distant ones are folded into the tile's far occlusion, the others are listed for solid_angle.cl.
// Each fold changes V by at most `each`, all of a tile together by at most `budget`. One work-item per tile; built with
// W = 16 (16 fragments, then 16 spheres, at a time) and -DSHARE as solid_angle.cl.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/tile_spheres.h"

kernel void list_tile_spheres(global const float* position_x, global const float* position_y,
                              global const float* position_z, global const float* normal_x,
                              global const float* normal_y, global const float* normal_z, global const uint* owner,
                              global const uint* validity, global const int* owner_group, uint owners,
                              global const ShadingSphere* spheres, uint sphere_count, float each, float budget,
                              uint row_length, uint units, uint tile_total, global TileOcclusion* tiles,
                              global uint* lists, uint capacity) {
  const uint tile = get_global_id(0);
  if (tile >= tile_total) return;
  const uint column = tile % tile_columns(row_length), top = tile / tile_columns(row_length) * TILE_ROWS;
  TileBounds bounds = no_bounds();
  for (uint row = top; row < top + TILE_ROWS; ++row) {
    const uint unit = first_unit(row, row_length) + column;
    if (unit >= min(first_unit(row + 1, row_length), units)) continue;
    const real x = LOAD(position_x, unit), y = LOAD(position_y, unit), z = LOAD(position_z, unit);
    const truth drawn = ((LOAD(validity, unit) & (bits)(VALIDITY_BACKGROUND)) == (bits)(0u)) & in_reach(x, y, z);
    if (!ANY(drawn)) continue;
    include(&bounds.x, x, drawn);
    include(&bounds.y, y, drawn);
    include(&bounds.z, z, drawn);
    include(&bounds.a, LOAD(normal_x, unit), drawn);
    include(&bounds.b, LOAD(normal_y, unit), drawn);
    include(&bounds.c, LOAD(normal_z, unit), drawn);
    bounds.groups |= groups_of(signed_owner_column(owner_group, owner_row(LOAD(owner, unit), owners)), drawn);
  }
  const TileView view = view_of(bounds);

  FarField field = no_field();
  uint listed = 0;
  for (uint first = 0; first < sphere_count && view.drawn; first += W) {
    const SphereLanes lanes = load_spheres(spheres, first, sphere_count);
    const SphereBounds reach = bound_spheres(view, lanes);
    const truth folded = choose_folded(view, lanes, reach, each, budget, &field);
    fold(view, lanes, reach, folded, &field);
    int kept[W];
    STORE(reach.seen & NOT(folded), kept, 0);
    for (uint lane = 0; lane < W; ++lane)
      if (kept[lane]) {
        if (listed < capacity) lists[tile * capacity + listed] = first + lane;
        ++listed;
      }
  }
  // With more spheres than the list holds, every sphere is tried and none is folded.
  tiles[tile] = listed <= capacity ? tile_occlusion(field, view.groups, listed)
                                   : tile_occlusion(no_field(), view.groups, ALL_SPHERES);
}
