// The cap of sphere_cap.h for an ellipsoidal crown (Hegeman et al. 2006, section 3): space is scaled so that the shell
// becomes the unit sphere. The plane goes with it: normals take the inverse transpose. The cap's volume comes back by
// abc, the product of the radii, so that alpha rho keeps its unit.
#ifndef UNDERSTORY_ELLIPSOID_CAP_H
#define UNDERSTORY_ELLIPSOID_CAP_H

#include "kernels/shared/sphere_cap.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

typedef struct {
  real x, y, z;
} Direction;

SHARED real dot_product(Direction u, Direction v) { return fma(u.x, v.x, fma(u.y, v.y, u.z * v.z)); }

/// `offset`: fragment from the ellipsoid's centre, m. `first`, `second`, `third`: rows of the map to the unit sphere,
/// 1/m, at right angles to each other, each along an axis and as long as 1 / radius.
SHARED Direction to_unit_sphere(Direction offset, Direction first, Direction second, Direction third) {
  Direction unit;
  unit.x = dot_product(first, offset);
  unit.y = dot_product(second, offset);
  unit.z = dot_product(third, offset);
  return unit;
}

/// V by eq. 6. `unit`: of to_unit_sphere; `squares`: of the radii along the rows, m^2; `volume_scale`: abc, m^3;
/// `alpha_rho`: 1/m^3.
SHARED real ellipsoid_cap(Direction unit, Direction normal, Direction first, Direction second, Direction third,
                          Direction squares, real volume_scale, real alpha_rho) {
  // The inverse transpose of rows m_i at right angles has the rows m_i / |m_i|^2, and 1 / |m_i| is the radius along m_i.
  const real a = squares.x * dot_product(first, normal), b = squares.y * dot_product(second, normal),
             c = squares.z * dot_product(third, normal);
  // Eq. 4 and 5 with h = H / r and d = |unit x n| / r, r being the length of n = (a, b, c): with one division.
  const real square = at_least(fma(a, a, fma(b, b, c * c)), REAL(1e-30)), r = sqrt(square);
  const real s = fma(unit.x, a, fma(unit.y, b, unit.z * c));
  const real h = at_most(at_least(r - s, REAL(0.0)), REAL(2.0) * r), h_square = h * h;
  const real ox = fma(unit.y, c, -(unit.z * b)), oy = fma(unit.z, a, -(unit.x * c)), oz = fma(unit.x, b, -(unit.y * a));
  const real off_axis = fma(ox, ox, fma(oy, oy, oz * oz));
  const real below = at_least(h_square + off_axis, REAL(1e-30) * square) * (square * r);
  const real above = REAL(1.0471975511965976) * alpha_rho * volume_scale * h_square * h_square * fma(REAL(3.0), r, -h);
  return cap_visibility(above / below);
}

#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
