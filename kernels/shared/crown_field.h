// A plant's visibility field: per cell of a grid around the plant at rest, what its surfaces there see of the sky as a
// function of normal and position, quadratic in the normal (spherical harmonics up to order 2, as polynomials) and
// linear in the position. Fitted to rays by host/trace/crown_field.cpp; the horizon and the cosine are in the fit.
//   V = c0 + c1 nx + c2 ny + c3 nz + c4 nx ny + c5 ny nz + c6 nz nx + c7 (nz^2 - 1/3) + c8 (nx^2 - ny^2)
//     + c9 qx + c10 qy + c11 qz        q: position from the cell's middle in half-edges, [-1, 1]
#ifndef UNDERSTORY_CROWN_FIELD_H
#define UNDERSTORY_CROWN_FIELD_H

#include "kernels/shared/limits.h"
#include "kernels/shared/records.h"

#define FIELD_COEFFICIENTS 12
#define FIELD_WORDS 3  // of 32 bits per cell: coefficients are signed bytes, the first in the lowest bits
#define FIELD_STEP 0.01f  // V per unit of a byte: [-1.27, 1.27], rounding at most 0.005 each

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

/// One prototype's grid. Cell (i, j, k) is number first_cell + (k rows + j) columns + i.
typedef struct {
  float low_x, low_y, low_z;             // m, prototype frame
  float cells_per_metre;
  record_uint columns, rows, layers;     // at least 1 each
  record_uint first_cell;
} CrownFieldGrid;                        // 32 bytes

/// V of one cell, not yet limited to [0, 1], in units of FIELD_STEP. (x, y, z): unit normal, prototype frame; (a, b, c):
/// q of the table above.
#define FIELD_VALUE(coefficient, x, y, z, a, b, c)                                                              \
  (coefficient(0) + coefficient(1) * (x) + coefficient(2) * (y) + coefficient(3) * (z) +                        \
   coefficient(4) * ((x) * (y)) + coefficient(5) * ((y) * (z)) + coefficient(6) * ((z) * (x)) +                 \
   coefficient(7) * ((z) * (z) - REAL(0.33333333)) + coefficient(8) * ((x) * (x) - (y) * (y)) +                 \
   coefficient(9) * (a) + coefficient(10) * (b) + coefficient(11) * (c))

#ifndef __OPENCL_C_VERSION__
static_assert(sizeof(CrownFieldGrid) == 32);
}  // namespace understory
#endif
#endif
