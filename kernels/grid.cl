// `grid`: the occluded share of the sphere around each fragment, looked up in the grids of the bodies near it (Malmer et
// al. 2005 section 4). V is the product over the bodies of 1 - 2 ao', ao' of eq. 5: exact for V_u and, averaged over the
// directions that a small body may lie in, for V_c. On the body itself its own surface fills one hemisphere:
// 1 - clamp(2 ao' - 1), or with -DSELF_PAPER the paper's half of it; ao' is taken as before the border's rescale.
// One work-item per W fragments; planes are padded (host/passes/planes.hpp).
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/grid_lookup.h"
#include "kernels/shared/owner_table.h"
#include "kernels/shared/shading_sphere.h"
#include "kernels/shared/tile_grids.h"
#include "kernels/shared/validity.h"

#ifdef SELF_PAPER
#define SELF_SHARE REAL(0.5)
#else
#define SELF_SHARE REAL(1.0)
#endif

kernel void shade_grid(global const float* position_x, global const float* position_y, global const float* position_z,
                       global const uint* owner, global const int* owner_group, uint owners,
                       global const GridRecord* grids, uint grid_count, global const uchar* samples,
                       global const uint* listed, global const uint* lists, uint capacity, uint row_length, uint items,
                       global float* visibility, global uint* validity) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  const TileGrids here = grids_of_item(listed, capacity, row_length, grid_count, i);
  const real x = LOAD(position_x, i), y = LOAD(position_y, i), z = LOAD(position_z, i);
  const truth drawn =
      ((LOAD(validity, i) & (bits)(VALIDITY_BACKGROUND)) == (bits)(0u)) & in_reach(x, y, z);
  if (here.count == 0 || !ANY(drawn)) {
    STORE(REAL(1.0), visibility, i);
    return;
  }
  const whole group = signed_owner_column(owner_group, owner_row(LOAD(owner, i), owners));
  real v = REAL(1.0);
  truth border = (truth)(0), solid = (truth)(0);
  for (uint j = 0; j < here.count; ++j) {
    global const GridRecord* grid = grids + grid_of_tile(here, lists, j);
    const GridPoint p = grid_point(grid, x, y, z);
    const truth inside = p.inside & drawn;
    if (!ANY(inside)) continue;
    const real share = look_up_share(grid, samples, p, inside, &solid);
    const real traced = fma(share, REAL(1.0) - (real)(grid->border), (real)(grid->border));
    const real self = SELF_SHARE * at_least(fma(REAL(2.0), traced, REAL(-1.0)), REAL(0.0));
    const truth own = (group == (whole)(grid->group)) & (group >= 0);
    const real blocked = at_most(PICK(own, self, REAL(2.0) * share), REAL(1.0));
    v = PICK(inside, fma(-v, blocked, v), v);
    border |= p.border & drawn;
  }
  STORE(PICK(drawn, as_visibility(v), REAL(1.0)), visibility, i);
  if (ANY(border)) add_validity(validity, i, border, VALIDITY_GRID_BORDER);
  if (ANY(solid)) add_validity(validity, i, solid, VALIDITY_OCCLUDER_TOO_CLOSE);
}
