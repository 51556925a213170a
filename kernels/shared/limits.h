// Bounds that keep bad numbers out: NaN takes the named side, so that no pass hands on anything but [0, 1].
#ifndef UNDERSTORY_LIMITS_H
#define UNDERSTORY_LIMITS_H

#include "kernels/shared/real.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

/// The greater of x and `low`; `low` for NaN.
SHARED real at_least(real x, real low) { return PICK(x > low, x, low); }

/// The lesser of x and `high`; `high` for NaN.
SHARED real at_most(real x, real high) { return PICK(x < high, x, high); }

/// x within [0, 1]; NaN becomes 1: what cannot be judged is open (FORMULAS.md, validity code 2).
SHARED real as_visibility(real x) { return at_least(at_most(x, REAL(1.0)), REAL(0.0)); }

#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
