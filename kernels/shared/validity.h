// Validity codes that the visibility kernels set: bit flags of sim/frame.hpp (FORMULAS.md, "Validity codes").
#ifndef UNDERSTORY_VALIDITY_H
#define UNDERSTORY_VALIDITY_H

#define VALIDITY_BACKGROUND 1u
#define VALIDITY_NOT_FINITE 2u
#define VALIDITY_NOT_UNIT 4u
#define VALIDITY_OUTSIDE_MODEL 8u
#define VALIDITY_OCCLUDER_TOO_CLOSE 16u
#define VALIDITY_RADIUS_OUT_OF_RANGE 32u
#define VALIDITY_LEFT_IMAGE 64u
#define VALIDITY_GRID_BORDER 128u

#ifdef __OPENCL_C_VERSION__
#include "kernels/shared/real.h"

/// Adds a code to the `flagged` lanes of work-item i. Call it only where there are any: codes are rare, and the plane
/// is not touched otherwise.
static inline void add_validity(global uint* validity, size_t i, truth flagged, uint code) {
  STORE(LOAD(validity, i) | PICK(flagged, (bits)(code), (bits)(0u)), validity, i);
}
#endif

#endif
