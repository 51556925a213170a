// The cheapest own model: one constant for plants of the chosen classes (Hegeman et al. 2006, "ambient"), and for the
// terrain the mean visibility of the ground under its grass, a bilinear lookup in a grid. Other fragments get 1.
// One work-item per W fragments; planes are padded (host/passes/planes.hpp).
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/ground_cover.h"
#include "kernels/shared/lane_bits.h"
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
    uint corner[W], across[W], up_row[W];
    float right[W], up[W];
    STORE(cell.low_left, corner, 0);
    STORE(cell.low_right - cell.low_left, across, 0);
    STORE(cell.high_left - cell.low_left, up_row, 0);
    STORE(cell.right, right, 0);
    STORE(cell.up, up, 0);
    for (uint left = lane_bits(is_terrain & cell.within); left != 0;) {
      const uint lane = next_lane(&left);
      global const float* low_pair = ground + corner[lane];
      global const float* high_pair = low_pair + up_row[lane];
      const float low = fma(right[lane], low_pair[across[lane]] - low_pair[0], low_pair[0]);
      const float high = fma(right[lane], high_pair[across[lane]] - high_pair[0], high_pair[0]);
      v = PICK((whole)((int)lane) == LANE_NUMBERS, (real)(fma(up[lane], high - low, low)), v);
    }
  }
  STORE(as_visibility(v), visibility, i);
}
