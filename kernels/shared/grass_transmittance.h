// Visibility among grass from a grid of the light there (GrassLayer in sim/grass_layer.hpp). Each node holds
//   V_c(n) = (1 + n_z) (above + zenith n_z) + x n_x + y n_y + below (1 - n_z)
// interpolated between columns and levels. What comes out is V_c over the open dome's factor, so that the dome
// multiplies it like everything else; under an open lower sky (below > 0) it is V_c itself.
#ifndef UNDERSTORY_GRASS_TRANSMITTANCE_H
#define UNDERSTORY_GRASS_TRANSMITTANCE_H

#include "kernels/shared/open_dome.h"

#ifdef __OPENCL_C_VERSION__
typedef uint layer_count;
typedef float layer_number;
#else
namespace understory {
typedef std::uint32_t layer_count;
typedef float layer_number;
#endif

/// Groups of W fragments that a work-item takes: so many that one group's waiting is another's work. At W = 1 the
/// device has other work-items for that.
#define GRASS_GROUPS(lanes) ((lanes) == 1 ? 1 : 8)

/// The grid's extent.
typedef struct {
  layer_number low_x, low_y;  // low corner, camera-relative m
  layer_number columns_per_metre, rows_per_metre;
  layer_count columns, rows;  // 0: no grass
  layer_count levels;
  layer_number levels_per_metre;
  layer_number datum;  // zero of the columns' ground, camera-relative m
} GrassLayerGrid;      // 36 bytes

typedef struct {
  real above, zenith, x, y, below;
} GrassLight;

/// V_c of a normal (a, b, c).
SHARED real grass_light(const GrassLight light, real a, real b, real c) {
  const real up = REAL(1.0) + c;
  const real lit = fma(up, fma(light.zenith, c, light.above), fma(light.x, a, light.y * b));
  return fma(light.below, REAL(1.0) - c, lit);
}

/// V_c over that of the open dome. Facing down, where both vanish, the divisor stays away from 0.
SHARED real grass_transmittance(const GrassLight light, real a, real b, real c) {
  return as_visibility(grass_light(light, a, b, c) / at_least(open_dome(c), REAL(0.01)));
}

#ifndef __OPENCL_C_VERSION__
static_assert(sizeof(GrassLayerGrid) == 36);
}  // namespace understory
#endif
#endif
