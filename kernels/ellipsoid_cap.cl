// Visibility of foliage inside its crown ellipsoid (shared/ellipsoid_cap.h). Each fragment finds its crown through its
// owner; fragments without a crown get 1. One work-item per W fragments; planes are padded (host/passes/planes.hpp).
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/ellipsoid_cap.h"
#include "kernels/shared/owner_table.h"
#include "kernels/shared/records.h"
#include "kernels/shared/validity.h"

SHARED Direction row_of(global const CrownRecord* shell, uint first) {
  const Direction row = {(real)(shell->to_unit[first]), (real)(shell->to_unit[first + 1]),
                         (real)(shell->to_unit[first + 2])};
  return row;
}

kernel void shade_ellipsoid_cap(global const float* position_x, global const float* position_y,
                                global const float* position_z, global const float* normal_x,
                                global const float* normal_y, global const float* normal_z, global const uint* owner,
                                global const int* owner_crown, uint owners, global const CrownRecord* crowns,
                                uint crown_count, uint items, global float* visibility, global uint* validity) {
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
    const Direction offset = {LOAD(position_x, i) - shell->centre_x, LOAD(position_y, i) - shell->centre_y,
                              LOAD(position_z, i) - shell->centre_z};
    const Direction normal = {LOAD(normal_x, i), LOAD(normal_y, i), LOAD(normal_z, i)};
    const Direction first = row_of(shell, 0), second = row_of(shell, 4), third = row_of(shell, 8);
    const Direction unit = to_unit_sphere(offset, first, second, third);
    const real shaded =
        ellipsoid_cap(unit, normal, first, second, third, (real)(shell->volume_scale), (real)(shell->alpha_rho));
    v = PICK(lanes, shaded, v);
    outside |= lanes & outside_sphere(unit.x, unit.y, unit.z, REAL(1.0));
  }
  STORE(v, visibility, i);
  if (ANY(outside)) add_validity(validity, i, outside, VALIDITY_OUTSIDE_MODEL);
}
