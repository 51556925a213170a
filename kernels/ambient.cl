// The cheapest own model: one constant for plants of the chosen classes (Hegeman et al. 2006, "ambient"), and for the
// terrain the mean visibility of the ground under its grass, a bilinear lookup in a grid. Other fragments get 1.
// One work-item per W fragments; planes are padded (host/passes/planes.hpp).
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/ground_cover.h"
#include "kernels/shared/limits.h"
#include "kernels/shared/owner_table.h"

kernel void shade_ambient(global const float* position_x, global const float* position_y, global const uint* owner,
                          global const uint* owner_class, uint owners, float share, uint share_classes,
                          uint terrain_class, const GroundCoverGrid grid, global const float* ground, uint items,
                          global float* visibility) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  const bits surface = owner_column(owner_class, owner_row(LOAD(owner, i), owners));
  const truth is_chosen = ((bits)(share_classes) >> surface & (bits)(1u)) != (bits)(0u);
  real v = PICK(is_chosen, (real)(share), REAL(1.0));
  const truth is_terrain = surface == (bits)(terrain_class);
  if (ANY(is_terrain)) {
    const GroundCoverCell cell = ground_cover_cell(grid, LOAD(position_x, i), LOAD(position_y, i));
    const real low_left = GATHER(real, ground, cell.low_left, ), low_right = GATHER(real, ground, cell.low_right, );
    const real high_left = GATHER(real, ground, cell.high_left, ), high_right = GATHER(real, ground, cell.high_right, );
    const real low = fma(cell.right, low_right - low_left, low_left);
    const real high = fma(cell.right, high_right - high_left, high_left);
    v = PICK(is_terrain & cell.within, fma(cell.up, high - low, low), v);
  }
  STORE(as_visibility(v), visibility, i);
}
