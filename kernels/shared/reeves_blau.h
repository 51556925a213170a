// Reeves and Blau 1985 as Hegeman et al. 2006 describe it: ambient light falls off exponentially with the depth of a
// point in its crown, V = A exp(-a depth); depth is the shortest way to the sphere's boundary. A stand-in for V, fitted.
#ifndef UNDERSTORY_REEVES_BLAU_H
#define UNDERSTORY_REEVES_BLAU_H

#include "kernels/shared/exp_minus.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

/// (x, y, z): fragment from the sphere's centre, m; `ambient`: A; `extinction`: a, 1/m.
SHARED real reeves_blau(real x, real y, real z, real radius, real ambient, real extinction) {
  const real distance = sqrt(fma(x, x, fma(y, y, z * z)));
  const real depth = at_least(radius - distance, REAL(0.0));
  const real v = as_visibility(ambient * exp_minus(at_least(extinction * depth, REAL(0.0))));
  return PICK(distance == distance, v, REAL(1.0));  // not a number: open
}

#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
