// The share of the dome above the horizon that a tilted plane faces. `sky: dome` multiplies it onto every method that
// knows nothing of the horizon (FORMULAS.md, "Quantities").
#ifndef UNDERSTORY_OPEN_DOME_H
#define UNDERSTORY_OPEN_DOME_H

#include "kernels/shared/limits.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

/// Cosine-weighted (V_c): (1 + cos t)/2, cos t = `normal_z` for a unit normal and z up.
SHARED real open_dome(real normal_z) { return as_visibility(fma(REAL(0.5), normal_z, REAL(0.5))); }

#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
