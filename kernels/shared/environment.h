// Ambient light from an environment map where a cone of it is occluded, Malmer et al. 2005 section 5.3: the light that
// the surface would receive, less that of the occluded cone. Directions are looked up in tables over an octahedral map
// of the sphere (Engelhardt and Dachsbacher 2008), which needs no trigonometry and has no seam at the nodes.
#ifndef UNDERSTORY_ENVIRONMENT_H
#define UNDERSTORY_ENVIRONMENT_H

#include "kernels/shared/limits.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

/// A place in the square [0, 1]^2; +z is its middle, -z all four corners.
typedef struct {
  real u, v;
} OctahedralPlace;

typedef struct {
  real x, y, z;
} OctahedralDirection;

/// |magnitude| with the sign of `like`; positive for 0.
SHARED real with_sign(real magnitude, real like) { return PICK(like < REAL(0.0), -magnitude, magnitude); }

/// (x, y, z) of any length but 0.
SHARED OctahedralPlace octahedral_place(real x, real y, real z) {
  const real inverse = REAL(1.0) / at_least(fabs(x) + fabs(y) + fabs(z), REAL(1e-30));
  const real p = x * inverse, q = y * inverse;
  const truth below = z < REAL(0.0);
  const real u = PICK(below, with_sign(REAL(1.0) - fabs(q), p), p);
  const real v = PICK(below, with_sign(REAL(1.0) - fabs(p), q), q);
  const OctahedralPlace place = {at_most(at_least(fma(u, REAL(0.5), REAL(0.5)), REAL(0.0)), REAL(1.0)),
                                 at_most(at_least(fma(v, REAL(0.5), REAL(0.5)), REAL(0.0)), REAL(1.0))};
  return place;
}

/// Not of unit length.
SHARED OctahedralDirection octahedral_direction(OctahedralPlace place) {
  const real p = fma(place.u, REAL(2.0), REAL(-1.0)), q = fma(place.v, REAL(2.0), REAL(-1.0));
  const real z = REAL(1.0) - fabs(p) - fabs(q);
  const truth below = z < REAL(0.0);
  const OctahedralDirection direction = {PICK(below, with_sign(REAL(1.0) - fabs(q), p), p),
                                         PICK(below, with_sign(REAL(1.0) - fabs(p), q), q), z};
  return direction;
}

/// One channel of the light that arrives, relative to a surface under an open sky of radiance 1. `visibility`: V, of all
/// occluders; `occluded`: the share that the cone takes of it, V = (1 - occluded) times the rest; `open_sky`: mean
/// radiance of the sky that the surface faces, `in_cone`: of the occluded part. A constant sky gives V times its
/// radiance. V beyond 1 - occluded, which another rule of combining may leave, sees the mean.
SHARED real light_beside_cone(real visibility, real occluded, real open_sky, real in_cone) {
  const real open = at_least(REAL(1.0) - occluded, REAL(0.0));
  const real beside = at_least(fma(-occluded, in_cone, open_sky), REAL(0.0)) / at_least(open, REAL(1e-4));
  const real seen = at_most(visibility, open);
  return fma(seen, beside, (visibility - seen) * open_sky);
}

#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
