// Where a point lies in the grid of ground visibility under grass (GroundCover in sim/world.hpp): values belong to the
// middles of cells and are interpolated between them; beyond the outer middles the nearest ones hold.
#ifndef UNDERSTORY_GROUND_COVER_H
#define UNDERSTORY_GROUND_COVER_H

#include "kernels/shared/limits.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
typedef std::uint32_t record_count;
#else
typedef uint record_count;
#endif

/// A grid of `columns` x `rows` cells, row-major from its low corner; 0 x 0: no grass.
typedef struct {
  float low_x, low_y;                        // low corner, camera-relative m
  float cells_per_metre_x, cells_per_metre_y;
  record_count columns, rows;
  float padding_[2];
} GroundCoverGrid;                           // 32 bytes

#ifdef __OPENCL_C_VERSION__

typedef struct {
  bits low_left, low_right, high_left, high_right;  // elements of the grid, always within it
  real right, up;                                   // shares of the right and of the high pair
  truth within;                                     // the grid's extent holds the point
} GroundCoverCell;

/// (x, y): camera-relative m.
SHARED GroundCoverCell ground_cover_cell(const GroundCoverGrid grid, real x, real y) {
  const real columns = (real)((float)grid.columns), rows = (real)((float)grid.rows);
  const real across = (x - (real)(grid.low_x)) * (real)(grid.cells_per_metre_x);
  const real up = (y - (real)(grid.low_y)) * (real)(grid.cells_per_metre_y);
  GroundCoverCell cell;
  cell.within = (across >= REAL(0.0)) & (across <= columns) & (up >= REAL(0.0)) & (up <= rows);
  const real column = at_least(at_most(across - REAL(0.5), columns - REAL(1.0)), REAL(0.0));
  const real row = at_least(at_most(up - REAL(0.5), rows - REAL(1.0)), REAL(0.0));
  const real left = TO_REAL(TO_WHOLE(column)), low = TO_REAL(TO_WHOLE(row));
  cell.right = column - left;
  cell.up = row - low;
  const bits left_column = TO_BITS(left), low_row = TO_BITS(low);
  const bits right_column = TO_BITS(at_least(at_most(left + REAL(1.0), columns - REAL(1.0)), REAL(0.0)));
  const bits high_row = TO_BITS(at_least(at_most(low + REAL(1.0), rows - REAL(1.0)), REAL(0.0)));
  cell.low_left = low_row * (bits)(grid.columns) + left_column;
  cell.low_right = low_row * (bits)(grid.columns) + right_column;
  cell.high_left = high_row * (bits)(grid.columns) + left_column;
  cell.high_right = high_row * (bits)(grid.columns) + right_column;
  return cell;
}

#else
static_assert(sizeof(GroundCoverGrid) == 32);
}  // namespace understory
#endif
#endif
