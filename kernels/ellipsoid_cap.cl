// Visibility of foliage inside its crown ellipsoid (shared/ellipsoid_cap.h). Each fragment finds its crown through its
// owner; fragments without a crown get 1. One work-item per W fragments; planes are padded (host/passes/planes.hpp).
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/ellipsoid_cap.h"
#include "kernels/shared/fetch_ahead.h"
#include "kernels/shared/owner_table.h"
#include "kernels/shared/records.h"
#include "kernels/shared/validity.h"

static inline Direction from_record(global const float* number, uint step) {
  const Direction direction = {(real)(number[0]), (real)(number[step]), (real)(number[2 * step])};
  return direction;
}

/// V of the lanes of one crown. `outside`: those beyond its ellipsoid.
static inline real shade(global const CrownRecord* shell, Direction position, Direction normal,
                         PRIVATE truth* outside) {
  const Direction offset = {position.x - shell->centre_x, position.y - shell->centre_y, position.z - shell->centre_z};
  const Direction first = from_record(shell->to_unit, 1), second = from_record(shell->to_unit + 4, 1),
                  third = from_record(shell->to_unit + 8, 1), squares = from_record(shell->to_unit + 3, 4);
  const Direction unit = to_unit_sphere(offset, first, second, third);
  *outside = outside_sphere(unit.x, unit.y, unit.z, REAL(1.0));
  return ellipsoid_cap(unit, normal, first, second, third, squares, (real)(shell->volume_scale),
                       (real)(shell->alpha_rho));
}

kernel void shade_ellipsoid_cap(global const float* position_x, global const float* position_y,
                                global const float* position_z, global const float* normal_x,
                                global const float* normal_y, global const float* normal_z, global const uint* owner,
                                global const int* owner_crown, uint owners, global const CrownRecord* crowns,
                                uint crown_count, uint items, global float* visibility, global uint* validity) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  fetch_planes(position_x, position_y, position_z, i);
  fetch_planes(normal_x, normal_y, normal_z, i);
  fetch_plane(owner, i);
  const bits rows = owner_row(LOAD(owner, i), owners);
  const Direction position = {LOAD(position_x, i), LOAD(position_y, i), LOAD(position_z, i)};
  const Direction normal = {LOAD(normal_x, i), LOAD(normal_y, i), LOAD(normal_z, i)};
  real v = REAL(1.0);
  truth outside = (truth)(0);
  if (ONE_OWNER(rows)) {
    const int crown = owner_crown[FIRST_LANE(rows)];
    if (crown >= 0 && crown < (int)crown_count) v = shade(crowns + crown, position, normal, &outside);
  } else {
    const whole crown = signed_owner_column(owner_crown, rows);
    for (truth left = (crown >= 0) & (crown < (whole)((int)crown_count)); ANY(left);) {
      const uint row = next_owner(TO_BITS(crown), left);
      const truth lanes = left & (crown == (whole)((int)row));
      left &= NOT(lanes);
      truth out;
      v = PICK(lanes, shade(crowns + row, position, normal, &out), v);
      outside |= lanes & out;
    }
  }
  STORE(v, visibility, i);
  if (ANY(outside)) add_validity(validity, i, outside, VALIDITY_OUTSIDE_MODEL);
}
