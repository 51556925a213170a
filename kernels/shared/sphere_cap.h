// Visibility inside a crown, Hegeman et al. 2006 section 3: the fragment's tangent plane cuts a cap off the shell, and
// the cap's volume stands for the leaves in the way. Approximates V_u; used for V_c times the open-dome factor.
//   eq. 4  Vcap = pi h^2 (3R - h)/3      h: height of the cap, clamp(R - s, 0, 2R), s: signed distance of plane from centre
//   eq. 5  f = h^2/(h^2 + d^2)           d: distance of the fragment from the cap's axis
//   eq. 6  V = exp(-alpha rho f Vcap)
#ifndef UNDERSTORY_SPHERE_CAP_H
#define UNDERSTORY_SPHERE_CAP_H

#include "kernels/shared/exp_minus.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

/// f Vcap, m^3 (in units of the radius' unit). (x, y, z): fragment from the sphere's centre; (a, b, c): unit normal.
SHARED real cap_occluders(real x, real y, real z, real a, real b, real c, real radius) {
  const real s = fma(x, a, fma(y, b, z * c));
  const real h = at_most(at_least(radius - s, REAL(0.0)), REAL(2.0) * radius);
  // Component by component the offset from the axis keeps its digits, where |p|^2 - s^2 cancels.
  const real ox = fma(-s, a, x), oy = fma(-s, b, y), oz = fma(-s, c, z);
  const real off_axis = fma(ox, ox, fma(oy, oy, oz * oz));
  const real square = h * h;
  // f is 0/0 at h = d = 0 while f Vcap -> 0.
  const real share = square / at_least(square + off_axis, REAL(1e-30));
  return REAL(1.0471975511965976) * share * square * fma(REAL(3.0), radius, -h);
}

/// V of eq. 6. `alpha_rho`: 1/m^3; `occluders`: f Vcap, m^3.
SHARED real cap_visibility(real alpha_rho, real occluders) {
  return as_visibility(exp_minus(at_least(alpha_rho * occluders, REAL(0.0))));
}

/// V of the crown sphere.
SHARED real sphere_cap(real x, real y, real z, real a, real b, real c, real radius, real alpha_rho) {
  return cap_visibility(alpha_rho, cap_occluders(x, y, z, a, b, c, radius));
}

/// 1 where (x, y, z), relative to the centre, lies outside a sphere of `radius`; a little is rounding, not outside.
SHARED truth outside_sphere(real x, real y, real z, real radius) {
  return fma(x, x, fma(y, y, z * z)) > REAL(1.00001) * radius * radius;
}

#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
