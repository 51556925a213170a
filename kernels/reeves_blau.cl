// Ambient light by depth in the crown (shared/reeves_blau.h). Each fragment finds its crown through its owner;
// fragments without a crown get 1. One work-item per W fragments; planes are padded (host/passes/planes.hpp).
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/fetch_ahead.h"
#include "kernels/shared/owner_table.h"
#include "kernels/shared/records.h"
#include "kernels/shared/reeves_blau.h"
#include "kernels/shared/sphere_cap.h"
#include "kernels/shared/validity.h"

/// V of the lanes of one crown. `outside`: those beyond its sphere.
static inline real shade(global const CrownRecord* shell, real px, real py, real pz, PRIVATE truth* outside) {
  const real x = px - shell->x, y = py - shell->y, z = pz - shell->z, radius = (real)(shell->radius);
  *outside = outside_sphere(x, y, z, radius);
  return reeves_blau(x, y, z, radius, (real)(shell->ambient), (real)(shell->extinction));
}

kernel void shade_reeves_blau(global const float* position_x, global const float* position_y,
                              global const float* position_z, global const uint* owner, global const int* owner_crown,
                              uint owners, global const CrownRecord* crowns, uint crown_count, uint items,
                              global float* visibility, global uint* validity) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  fetch_planes(position_x, position_y, position_z, i);
  fetch_plane(owner, i);
  const bits rows = owner_row(LOAD(owner, i), owners);
  const real x = LOAD(position_x, i), y = LOAD(position_y, i), z = LOAD(position_z, i);
  real v = REAL(1.0);
  truth outside = (truth)(0);
  if (ONE_OWNER(rows)) {
    const int crown = owner_crown[FIRST_LANE(rows)];
    if (crown >= 0 && crown < (int)crown_count) v = shade(crowns + crown, x, y, z, &outside);
  } else {
    const whole crown = signed_owner_column(owner_crown, rows);
    for (truth left = (crown >= 0) & (crown < (whole)((int)crown_count)); ANY(left);) {
      const uint row = next_owner(TO_BITS(crown), left);
      const truth lanes = left & (crown == (whole)((int)row));
      left &= NOT(lanes);
      truth out;
      v = PICK(lanes, shade(crowns + row, x, y, z, &out), v);
      outside |= lanes & out;
    }
  }
  STORE(v, visibility, i);
  if (ANY(outside)) add_validity(validity, i, outside, VALIDITY_OUTSIDE_MODEL);
}
