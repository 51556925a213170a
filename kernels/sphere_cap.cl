// Visibility of foliage inside its crown sphere (shared/sphere_cap.h). Each fragment finds its crown through its owner;
// fragments without a crown get 1. One work-item per W fragments; planes are padded (host/passes/planes.hpp).
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/fetch_ahead.h"
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
  fetch_planes(position_x, position_y, position_z, i);
  fetch_planes(normal_x, normal_y, normal_z, i);
  fetch_plane(owner, i);
  const bits rows = owner_row(LOAD(owner, i), owners);
  const whole crown = signed_owner_column(owner_crown, rows);
  const truth mine = (crown >= 0) & (crown < (whole)((int)crown_count));
  if (!ANY(mine)) {
    STORE(REAL(1.0), visibility, i);
    return;
  }
  real cx, cy, cz, radius, alpha_rho;
  if (ONE_OWNER(rows)) {
    global const CrownRecord* shell = crowns + FIRST_LANE(crown);
    cx = (real)(shell->x);
    cy = (real)(shell->y);
    cz = (real)(shell->z);
    radius = (real)(shell->radius);
    alpha_rho = (real)(shell->alpha_rho);
  } else {
    cx = cy = cz = radius = alpha_rho = REAL(0.0);
    for (truth left = mine; ANY(left);) {
      const uint row = next_owner(TO_BITS(crown), left);
      const truth lanes = left & (crown == (whole)((int)row));
      left &= NOT(lanes);
      global const CrownRecord* shell = crowns + row;
      cx = PICK(lanes, (real)(shell->x), cx);
      cy = PICK(lanes, (real)(shell->y), cy);
      cz = PICK(lanes, (real)(shell->z), cz);
      radius = PICK(lanes, (real)(shell->radius), radius);
      alpha_rho = PICK(lanes, (real)(shell->alpha_rho), alpha_rho);
    }
  }
  const real x = LOAD(position_x, i) - cx, y = LOAD(position_y, i) - cy, z = LOAD(position_z, i) - cz;
  const real v = sphere_cap(x, y, z, LOAD(normal_x, i), LOAD(normal_y, i), LOAD(normal_z, i), radius, alpha_rho);
  const truth outside = mine & outside_sphere(x, y, z, radius);
  STORE(PICK(mine, v, REAL(1.0)), visibility, i);
  if (ANY(outside)) add_validity(validity, i, outside, VALIDITY_OUTSIDE_MODEL);
}
