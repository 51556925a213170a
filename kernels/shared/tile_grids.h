// What tile_grids.cl leaves for grid.cl and grid_cone.cl.
#ifndef UNDERSTORY_TILE_GRIDS_H
#define UNDERSTORY_TILE_GRIDS_H

#define ALL_GRIDS 0xffffffffu  // the tile's list was too short: every grid must be tried

#endif
