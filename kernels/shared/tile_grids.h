// What tile_grids.cl leaves for grid.cl and grid_cone.cl: which grids are worth looking into.
#ifndef UNDERSTORY_TILE_GRIDS_H
#define UNDERSTORY_TILE_GRIDS_H

#include "kernels/shared/fragment_tiles.h"
#include "kernels/shared/real.h"

#define ALL_GRIDS 0xffffffffu  // the tile's list was too short: every grid must be tried

/// The grids that a work-item's W fragments may lie in.
typedef struct {
  uint count;
  uint first;  // in the lists
  int all;     // not listed: 0, 1, ..., count - 1
} TileGrids;

SHARED TileGrids grids_of_item(global const uint* listed, uint capacity, uint row_length, uint grid_count, uint item) {
  const uint tile = tile_of_unit(item * W / UNIT, row_length);
  const int all = listed[tile] == ALL_GRIDS;
  const TileGrids grids = {all ? grid_count : listed[tile], tile * capacity, all};
  return grids;
}

SHARED uint grid_of_tile(const TileGrids grids, global const uint* lists, uint j) {
  return grids.all ? j : lists[grids.first + j];
}

#endif
