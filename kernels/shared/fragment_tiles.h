// Tiles of an image: 128 x 4 fragments that are near each other in space, so that one look at their bounds serves all.
// A unit is 16 consecutive fragments of the planes and belongs to the image row of its first one; a tile is 8 neighbouring
// units of each of 4 rows: wide, because memory is read along rows. Units partition the planes whatever the image's
// width is.
#ifndef UNDERSTORY_FRAGMENT_TILES_H
#define UNDERSTORY_FRAGMENT_TILES_H

#define UNIT 16u       // fragments
#define TILE_UNITS 8u  // units of a row
#define TILE_ROWS 4u   // image rows

#define LISTS 3u  // of spheres per tile: distant, close, near

#ifdef __OPENCL_C_VERSION__
typedef uint tile_count;
#define TILE_FUNCTION static inline
#else
#include <cstdint>
namespace understory {
typedef std::uint32_t tile_count;
#define TILE_FUNCTION inline
#endif

/// `row_length`: of the image, at least UNIT.
TILE_FUNCTION tile_count tile_columns(tile_count row_length) {
  return ((row_length + UNIT - 1u) / UNIT + TILE_UNITS - 1u) / TILE_UNITS;
}

/// The first unit that begins in `row`.
TILE_FUNCTION tile_count first_unit(tile_count row, tile_count row_length) {
  return (row * row_length + UNIT - 1u) / UNIT;
}

TILE_FUNCTION tile_count tile_of_unit(tile_count unit, tile_count row_length) {
  const tile_count row = unit * UNIT / row_length;
  return row / TILE_ROWS * tile_columns(row_length) + (unit - first_unit(row, row_length)) / TILE_UNITS;
}

/// Tiles of `units` units.
TILE_FUNCTION tile_count tiles_of_units(tile_count units, tile_count row_length) {
  if (units == 0u) return 0u;
  return ((units - 1u) * UNIT / row_length / TILE_ROWS + 1u) * tile_columns(row_length);
}

#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
