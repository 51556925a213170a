// Ambient light by depth in the crown (shared/reeves_blau.h). Each fragment finds its crown through its owner; fragments
// without a crown get 1. One work-item per W fragments; planes are padded (host/passes/planes.hpp).
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/owner_table.h"
#include "kernels/shared/records.h"
#include "kernels/shared/reeves_blau.h"
#include "kernels/shared/sphere_cap.h"
#include "kernels/shared/validity.h"

kernel void shade_reeves_blau(global const float* position_x, global const float* position_y,
                              global const float* position_z, global const uint* owner, global const int* owner_crown,
                              uint owners, global const CrownRecord* crowns, uint crown_count, uint items,
                              global float* visibility, global uint* validity) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  const whole crown = GATHER(whole, owner_crown, owner_row(LOAD(owner, i), owners), );
  const bits row = crown_row(crown, crown_count);
  const real x = LOAD(position_x, i) - GATHER(real, crowns, row, .x);
  const real y = LOAD(position_y, i) - GATHER(real, crowns, row, .y);
  const real z = LOAD(position_z, i) - GATHER(real, crowns, row, .z);
  const real radius = GATHER(real, crowns, row, .radius);

  const real shaded =
      reeves_blau(x, y, z, radius, GATHER(real, crowns, row, .ambient), GATHER(real, crowns, row, .extinction));
  const truth inside = has_crown(crown, crown_count);
  STORE(PICK(inside, shaded, REAL(1.0)), visibility, i);
  const bits flag = PICK(inside & outside_sphere(x, y, z, radius), (bits)(VALIDITY_OUTSIDE_MODEL), (bits)(0u));
  STORE(LOAD(validity, i) | flag, validity, i);
}
