// Visibility of foliage inside its crown ellipsoid (shared/ellipsoid_cap.h). Each fragment finds its crown through its
// owner; fragments without a crown get 1. One work-item per W fragments; planes are padded (host/passes/planes.hpp).
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/ellipsoid_cap.h"
#include "kernels/shared/owner_table.h"
#include "kernels/shared/records.h"
#include "kernels/shared/validity.h"

SHARED Direction gather_row(global const CrownRecord* crowns, bits crown, uint first) {
  Direction row;
  row.x = GATHER(real, crowns, crown, .to_unit[first]);
  row.y = GATHER(real, crowns, crown, .to_unit[first + 1]);
  row.z = GATHER(real, crowns, crown, .to_unit[first + 2]);
  return row;
}

kernel void shade_ellipsoid_cap(global const float* position_x, global const float* position_y,
                                global const float* position_z, global const float* normal_x,
                                global const float* normal_y, global const float* normal_z, global const uint* owner,
                                global const int* owner_crown, uint owners, global const CrownRecord* crowns,
                                uint crown_count, uint items, global float* visibility, global uint* validity) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  const whole crown = GATHER(whole, owner_crown, owner_row(LOAD(owner, i), owners), );
  const bits row = crown_row(crown, crown_count);
  Direction offset, normal;
  offset.x = LOAD(position_x, i) - GATHER(real, crowns, row, .centre_x);
  offset.y = LOAD(position_y, i) - GATHER(real, crowns, row, .centre_y);
  offset.z = LOAD(position_z, i) - GATHER(real, crowns, row, .centre_z);
  normal.x = LOAD(normal_x, i);
  normal.y = LOAD(normal_y, i);
  normal.z = LOAD(normal_z, i);

  const Direction first = gather_row(crowns, row, 0), second = gather_row(crowns, row, 4);
  const Direction third = gather_row(crowns, row, 8), unit = to_unit_sphere(offset, first, second, third);
  const real shaded = ellipsoid_cap(unit, normal, first, second, third, GATHER(real, crowns, row, .volume_scale),
                                    GATHER(real, crowns, row, .alpha_rho));
  const truth inside = has_crown(crown, crown_count);
  STORE(PICK(inside, shaded, REAL(1.0)), visibility, i);
  const truth outside = inside & outside_sphere(unit.x, unit.y, unit.z, REAL(1.0));
  STORE(LOAD(validity, i) | PICK(outside, (bits)(VALIDITY_OUTSIDE_MODEL), (bits)(0u)), validity, i);
}
