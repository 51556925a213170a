// Visibility of foliage inside its crown sphere (shared/sphere_cap.h). Each fragment finds its crown through its owner;
// fragments without a crown get 1. One work-item per W fragments; planes are padded (host/passes/planes.hpp).
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/owner_table.h"
#include "kernels/shared/records.h"
#include "kernels/shared/sphere_cap.h"
#include "kernels/shared/validity.h"

kernel void shade_sphere_cap(global const float* position_x, global const float* position_y,
                             global const float* position_z, global const float* normal_x, global const float* normal_y,
                             global const float* normal_z, global const uint* owner, global const int* owner_crown,
                             uint owners, global const CrownRecord* crowns, uint crown_count, uint items,
                             global float* visibility, global uint* validity) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  const whole crown = signed_owner_column(owner_crown, owner_row(LOAD(owner, i), owners));
  real v = REAL(1.0);
  truth outside = (truth)(0);
  for (truth left = (crown >= 0) & (crown < (whole)((int)crown_count)); ANY(left);) {
    const uint row = next_owner(TO_BITS(crown), left);
    const truth lanes = left & (crown == (whole)((int)row));
    left &= NOT(lanes);
    global const CrownRecord* shell = crowns + row;
    const real x = LOAD(position_x, i) - shell->x, y = LOAD(position_y, i) - shell->y;
    const real z = LOAD(position_z, i) - shell->z, radius = (real)(shell->radius);
    v = PICK(
        lanes,
        sphere_cap(x, y, z, LOAD(normal_x, i), LOAD(normal_y, i), LOAD(normal_z, i), radius, (real)(shell->alpha_rho)),
        v);
    outside |= lanes & outside_sphere(x, y, z, radius);
  }
  STORE(v, visibility, i);
  if (ANY(outside)) add_validity(validity, i, outside, VALIDITY_OUTSIDE_MODEL);
}
