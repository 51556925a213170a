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
  const real shrink = REAL(1.0) / sqrt(at_least(fma(a, a, fma(b, b, c * c)), REAL(1e-30)));
  const real occluders =
      volume_scale * cap_occluders(unit.x, unit.y, unit.z, a * shrink, b * shrink, c * shrink, REAL(1.0));
  return cap_visibility(alpha_rho, occluders);
}

#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
