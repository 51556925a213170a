// Visibility of grass by its height in the field (shared/grass_height.h); fragments of other classes
// get 1. One work-item per W fragments; planes are padded (host/passes/planes.hpp).
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/grass_height.h"
#include "kernels/shared/owner_table.h"
#include "kernels/shared/validity.h"

kernel void shade_grass_height(global const float* height_above_root, global const float* blade_length,
                               global const uint* owner, global const uint* owner_class, uint owners, uint blade_class,
                               uint items, global float* visibility, global uint* validity) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  const bits surface = owner_column(owner_class, owner_row(LOAD(owner, i), owners));
  const truth is_blade = surface == (bits)(blade_class);
  if (!ANY(is_blade)) {
    STORE((real)(1.0f), visibility, i);
    return;
  }
  const real height = LOAD(height_above_root, i), total = LOAD(blade_length, i);
  STORE(PICK(is_blade, grass_height(height, total), REAL(1.0)), visibility, i);
  const truth within = (height >= REAL(0.0)) & (height <= total) & (total > REAL(0.0));
  const truth outside = is_blade & NOT(within);
  if (ANY(outside)) add_validity(validity, i, outside, VALIDITY_OUTSIDE_MODEL);
}
