// Visibility of a plant's surfaces from its baked field (shared/crown_field.h): where the fragment was at rest picks a
// cell, the rest normal and the place in the cell give V. Fragments without a field get 1.
// One work-item per W fragments; planes are padded (host/passes/planes.hpp).
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/crown_field.h"
#include "kernels/shared/owner_table.h"
#include "kernels/shared/validity.h"

/// Cell along one axis of `count` cells; any number, NaN too, gives one of them.
static inline real cell_of(real place, uint count) {
  return at_least(at_most(floor(place), (real)((float)count - 1.0f)), REAL(0.0));
}

/// Place within the cell, -1 to 1.
static inline real within_cell(real place, real cell) {
  return at_least(at_most(fma(REAL(2.0), place - cell, REAL(-1.0)), REAL(1.0)), REAL(-1.0));
}

#define NOT_WITHIN(place, count) NOT(((place) >= REAL(-0.001)) & ((place) <= (real)((float)(count) + 0.001f)))
/// Signed byte `number` % 4 of the word that holds it.
#define COEFFICIENT(number) TO_REAL(AS_WHOLE(words[(number) / 4] << (24 - 8 * ((number) % 4))) >> 24)

kernel void shade_crown_field(global const float* rest_x, global const float* rest_y, global const float* rest_z,
                              global const float* normal_x, global const float* normal_y, global const float* normal_z,
                              global const uint* owner, global const int* owner_field, uint owners,
                              global const CrownFieldGrid* fields, uint field_count, global const uint* cells,
                              uint items, global float* visibility, global uint* validity) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  const bits owners_here = owner_row(LOAD(owner, i), owners);
  real v = REAL(1.0);
  truth outside = (truth)(0);
  for (truth left = ALL_LANES; ANY(left);) {
    const uint row = next_owner(owners_here, left);
    const truth lanes = left & (owners_here == (bits)(row));
    left &= NOT(lanes);
    const int number = owner_field[row];
    if (number < 0 || number >= (int)field_count) continue;
    const CrownFieldGrid field = fields[number];
    const real px = (LOAD(rest_x, i) - field.low_x) * field.cells_per_metre;
    const real py = (LOAD(rest_y, i) - field.low_y) * field.cells_per_metre;
    const real pz = (LOAD(rest_z, i) - field.low_z) * field.cells_per_metre;
    const real cx = cell_of(px, field.columns), cy = cell_of(py, field.rows), cz = cell_of(pz, field.layers);
    const bits column = TO_BITS(cx), line = TO_BITS(cz) * field.rows + TO_BITS(cy);
    const bits first = ((bits)(field.first_cell) + line * field.columns + column) * FIELD_WORDS;
    const bits words[FIELD_WORDS] = {GATHER(bits, cells, first, ), GATHER(bits, cells, first + 1, ),
                                     GATHER(bits, cells, first + 2, )};
    const real nx = LOAD(normal_x, i), ny = LOAD(normal_y, i), nz = LOAD(normal_z, i);
    const real value = FIELD_VALUE(COEFFICIENT, nx, ny, nz, within_cell(px, cx), within_cell(py, cy),
                                   within_cell(pz, cz));
    v = PICK(lanes, as_visibility(value * FIELD_STEP), v);
    outside |= lanes & (NOT_WITHIN(px, field.columns) | NOT_WITHIN(py, field.rows) | NOT_WITHIN(pz, field.layers));
  }
  STORE(v, visibility, i);
  if (ANY(outside)) add_validity(validity, i, outside, VALIDITY_OUTSIDE_MODEL);
}
