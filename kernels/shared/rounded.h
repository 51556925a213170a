// The nearest whole number by the rounding of an addition: floor and rint are up to ten instructions on vectors in PoCL.
#ifndef UNDERSTORY_ROUNDED_H
#define UNDERSTORY_ROUNDED_H

#include "kernels/shared/real.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

/// For |t| < 2^22.
SHARED real rounded(real t) {
#ifdef __OPENCL_C_VERSION__
  return (t + REAL(12582912.0)) - REAL(12582912.0);
#else
  return std::nearbyint(t);
#endif
}

#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
