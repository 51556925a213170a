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

/// density f Vcap. `s`: signed distance of the fragment's plane from the centre; `off_axis`: d^2.
SHARED real cap_content(real s, real off_axis, real radius, real density) {
  const real h = at_most(at_least(radius - s, REAL(0.0)), REAL(2.0) * radius);
  const real square = h * h;
  // f is 0/0 at h = d = 0 while f Vcap -> 0. The rest is multiplied beside the division, which takes longest.
  const real share = square / at_least(square + off_axis, REAL(1e-30));
  return share * (REAL(1.0471975511965976) * density * square * fma(REAL(3.0), radius, -h));
}

/// The same on a sphere. (x, y, z): fragment from its centre; (a, b, c): unit normal.
SHARED real cap_content_at(real x, real y, real z, real a, real b, real c, real radius, real density) {
  const real s = fma(x, a, fma(y, b, z * c));
  // Component by component the offset from the axis keeps its digits, where |p|^2 - s^2 cancels.
  const real ox = fma(-s, a, x), oy = fma(-s, b, y), oz = fma(-s, c, z);
  return cap_content(s, fma(ox, ox, fma(oy, oy, oz * oz)), radius, density);
}

/// f Vcap, m^3 (in units of the radius' unit).
SHARED real cap_occluders(real x, real y, real z, real a, real b, real c, real radius) {
  return cap_content_at(x, y, z, a, b, c, radius, REAL(1.0));
}

/// V of eq. 6. `content`: alpha rho f Vcap.
SHARED real cap_visibility(real content) { return as_visibility(exp_minus(at_least(content, REAL(0.0)))); }

/// V of the crown sphere. `alpha_rho`: 1/m^3.
SHARED real sphere_cap(real x, real y, real z, real a, real b, real c, real radius, real alpha_rho) {
  return cap_visibility(cap_content_at(x, y, z, a, b, c, radius, alpha_rho));
}

/// 1 where (x, y, z), relative to the centre, lies outside a sphere of `radius`; a little is rounding, not outside.
SHARED truth outside_sphere(real x, real y, real z, real radius) {
  return fma(x, x, fma(y, y, z * z)) > REAL(1.00001) * radius * radius;
}

#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
