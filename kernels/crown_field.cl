// Visibility of a plant's surfaces from its baked field (shared/crown_field.h): where the fragment was at rest picks a
// cell, the rest normal and the place in the cell give V. Fragments without a field get 1.
// One work-item per W fragments; planes are padded (host/passes/planes.hpp).
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/crown_field.h"
#include "kernels/shared/fetch_ahead.h"
#include "kernels/shared/owner_table.h"
#include "kernels/shared/validity.h"

/// Cell along one axis of `count` cells; any number, NaN too, gives one of them.
static inline real cell_of(real place, real count) {
  return at_least(at_most(floor(place), count - REAL(1.0)), REAL(0.0));
}

/// Place within the cell, -1 to 1.
static inline real within_cell(real place, real cell) {
  return at_least(at_most(fma(REAL(2.0), place - cell, REAL(-1.0)), REAL(1.0)), REAL(-1.0));
}

static inline truth beyond(real place, real count) {
  return NOT((place >= REAL(-0.001)) & (place <= count + REAL(0.001)));
}

/// Signed byte `number` % 4 of the word that holds it.
#define COEFFICIENT(number) TO_REAL(AS_WHOLE(words[(number) / 4] << (24 - 8 * ((number) % 4))) >> 24)
#define TAKE(member, from) member = PICK(lanes, from, member)

kernel void shade_crown_field(global const float* rest_x, global const float* rest_y, global const float* rest_z,
                              global const float* normal_x, global const float* normal_y, global const float* normal_z,
                              global const uint* owner, global const int* owner_field, uint owners,
                              global const CrownFieldGrid* fields, uint field_count, global const uint* cells,
                              uint items, global float* visibility, global uint* validity) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  fetch_planes(rest_x, rest_y, rest_z, i);
  fetch_planes(normal_x, normal_y, normal_z, i);
  fetch_plane(owner, i);
  const bits owners_here = owner_row(LOAD(owner, i), owners);
  const whole number = signed_owner_column(owner_field, owners_here);
  const truth mine = (number >= 0) & (number < (whole)((int)field_count));
  if (!ANY(mine)) {
    STORE(REAL(1.0), visibility, i);
    return;
  }
  const CrownFieldGrid one = fields[ONE_OWNER(owners_here) ? FIRST_LANE(number) : 0];
  real low_x = (real)(one.low_x), low_y = (real)(one.low_y), low_z = (real)(one.low_z);
  real scale = (real)(one.cells_per_metre);
  bits columns = (bits)(one.columns), rows = (bits)(one.rows), layers = (bits)(one.layers);
  bits first_cell = (bits)(one.first_cell);
  for (truth left = ONE_OWNER(owners_here) ? (truth)(0) : mine; ANY(left);) {
    const uint row = next_owner(TO_BITS(number), left);
    const truth lanes = left & (number == (whole)((int)row));
    left &= NOT(lanes);
    const CrownFieldGrid field = fields[row];
    TAKE(low_x, (real)(field.low_x));
    TAKE(low_y, (real)(field.low_y));
    TAKE(low_z, (real)(field.low_z));
    TAKE(scale, (real)(field.cells_per_metre));
    TAKE(columns, (bits)(field.columns));
    TAKE(rows, (bits)(field.rows));
    TAKE(layers, (bits)(field.layers));
    TAKE(first_cell, (bits)(field.first_cell));
  }
  const real px = (LOAD(rest_x, i) - low_x) * scale, py = (LOAD(rest_y, i) - low_y) * scale;
  const real pz = (LOAD(rest_z, i) - low_z) * scale;
  const real across = TO_REAL(columns), along = TO_REAL(rows), up = TO_REAL(layers);
  const real cx = cell_of(px, across), cy = cell_of(py, along), cz = cell_of(pz, up);
  const bits line = TO_BITS(cz) * rows + TO_BITS(cy);
  const bits first = (first_cell + line * columns + TO_BITS(cx)) * FIELD_WORDS;
  const bits words[FIELD_WORDS] = {GATHER(bits, cells, first, ), GATHER(bits, cells, first + 1, ),
                                   GATHER(bits, cells, first + 2, )};
  const real nx = LOAD(normal_x, i), ny = LOAD(normal_y, i), nz = LOAD(normal_z, i);
  const real value =
      FIELD_VALUE(COEFFICIENT, nx, ny, nz, within_cell(px, cx), within_cell(py, cy), within_cell(pz, cz));
  STORE(PICK(mine, as_visibility(value * FIELD_STEP), REAL(1.0)), visibility, i);
  const truth outside = mine & (beyond(px, across) | beyond(py, along) | beyond(pz, up));
  if (ANY(outside)) add_validity(validity, i, outside, VALIDITY_OUTSIDE_MODEL);
}
