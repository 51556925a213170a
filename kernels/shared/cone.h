// Cones of occluded directions, Malmer et al. 2005 section 5, as closed forms where the paper has tables.
// Solid angles are shares of the full sphere, in [0, 1]; half-angles beyond 90 degrees are allowed. A cone of aperture A
// has the half-angle h with cos h = 1 - 2A. b is the angle between a cone's axis and a normal, or another axis.
//   clip_cosine        T_clip: (1/pi) integral of the cosine over the cone above the plane (Snyder 1996: as of a sphere)
//   clip_solid_angle   T_clip: solid angle of the cone above the plane (Gauss-Bonnet)
//   clip_blend         T_clip: f of the mean direction above the plane, proportional to f d + (1 - f) n. It is 1 for a
//                      cone that the plane does not cut, as in the paper's text; its listing has the ends swapped.
//   merge_apertures    T_merge: solid angle of the union of two cones (Tovchigrechko and Vakser 2001)
// Errors in tests/kernels/cone_test.cpp.
#ifndef UNDERSTORY_CONE_H
#define UNDERSTORY_CONE_H

#include "kernels/shared/arc_tangent.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

#define CONE_INVERSE_PI REAL(0.3183098861837907)

/// Occluded directions: their share of the full sphere, and their mean direction times that share (sim/occlusion_grid.hpp).
typedef struct {
  real share, x, y, z;
} Occluded;

/// A cone that blocks `opacity` of what lies in it. The axis is a unit vector, or 0 where nothing is occluded.
typedef struct {
  real x, y, z, aperture, opacity;
} Cone;

/// Sine of the half-angle.
SHARED real cone_sine(real aperture) {
  return REAL(2.0) * sqrt(at_least(aperture * (REAL(1.0) - aperture), REAL(0.0)));
}

/// atan(y/x) for x >= 0 and y of either sign.
SHARED real cone_arc(real y, real x) {
  const real angle = arc_tangent(fabs(y), x);
  return PICK(y < REAL(0.0), -angle, angle);
}

/// acos(x); x is limited to [-1, 1].
SHARED real cone_arc_cosine(real x) {
  const real c = at_most(at_least(x, REAL(-1.0)), REAL(1.0));
  const real angle = arc_tangent(sqrt((REAL(1.0) - c) * (REAL(1.0) + c)), fabs(c));
  return PICK(c < REAL(0.0), REAL(3.141592653589793) - angle, angle);
}

/// The paper's cone: opaque, with the share as its aperture.
SHARED Cone opaque_cone(Occluded o) {
  const real inverse = REAL(1.0) / at_least(sqrt(fma(o.x, o.x, fma(o.y, o.y, o.z * o.z))), REAL(1e-12));
  const Cone cone = {o.x * inverse, o.y * inverse, o.z * inverse, o.share, REAL(1.0)};
  return cone;
}

/// The cone that blocks the same share with the same mean direction: a cone of aperture A and opacity p has the share p A
/// and a mean direction p A (1 - A) long, so A = 1 - |mean direction| / share. Directions that are scattered make a wide,
/// translucent cone. Where plane and cone do not cross, its clip_cosine is exact whatever the directions are.
SHARED Cone spread_cone(Occluded o) {
  const real length = at_least(sqrt(fma(o.x, o.x, fma(o.y, o.y, o.z * o.z))), REAL(1e-12));
  const real inverse = REAL(1.0) / length;
  const real share = at_least(o.share, REAL(1e-9));
  const real aperture = at_most(at_least(REAL(1.0) - length / share, share), REAL(1.0));
  const Cone cone = {o.x * inverse, o.y * inverse, o.z * inverse, aperture, at_most(o.share / aperture, REAL(1.0))};
  return cone;
}

/// `cosine`: cos b of the axis and the normal.
SHARED real clip_cosine(real aperture, real cosine) {
  const real r = cone_sine(aperture), q = fma(REAL(-2.0), aperture, REAL(1.0));
  const real s = at_most(at_least(cosine / at_least(r, REAL(1e-12)), REAL(-1.0)), REAL(1.0));
  // Wholly above, below, or around the plane: what a cone narrower than 90 degrees has above the plane is r^2 cos b.
  const truth wide = q < REAL(0.0), cut = fabs(cosine) < r;
  const real narrow = at_least(PICK(wide, -cosine, cosine), REAL(0.0)) * r * r;
  const real k = sqrt((REAL(1.0) - s) * (REAL(1.0) + s));
  const real lean = cone_arc(s * q, k);
  const real edge = arc_tangent(k * r, fabs(q));
  const real rise = PICK(wide, REAL(3.141592653589793) - edge, edge);
  const real between = CONE_INVERSE_PI * (cosine * r * r * (REAL(1.5707963267948966) + lean) - k * q * r + rise);
  const real share = PICK(cut, between, PICK(wide, REAL(1.0) - narrow, narrow));
  return at_most(at_least(share, REAL(0.0)), REAL(1.0));
}

/// Share of the full sphere, at most 1/2.
SHARED real clip_solid_angle(real aperture, real cosine) {
  const real r = cone_sine(aperture), q = fma(REAL(-2.0), aperture, REAL(1.0));
  const real s = at_most(at_least(cosine / at_least(r, REAL(1e-12)), REAL(-1.0)), REAL(1.0));
  const truth cut = fabs(cosine) < r, above = cosine > REAL(0.0);
  const real k = sqrt((REAL(1.0) - s) * (REAL(1.0) + s));
  const real lean = cone_arc(s * q, k), rise = cone_arc(s, k);
  const real between = REAL(0.5) * (aperture + CONE_INVERSE_PI * (rise - q * lean));
  const real clear = PICK(above, at_most(aperture, REAL(0.5)), at_least(aperture - REAL(0.5), REAL(0.0)));
  return at_most(at_least(PICK(cut, between, clear), REAL(0.0)), REAL(0.5));
}

/// f of the mean direction of the cone above the plane, f d + (1 - f) n, from the integral of the direction over it:
/// n (F - g cos b) + d g with F = clip_cosine and g = r^2 (acos(-w) + w sqrt(1 - w^2)) / pi, w = cos h cos b / (sin h sin b).
/// 0 where nothing is left. For a cone wider than 90 degrees g can be the larger one: then f > 1.
SHARED real clip_weight(real aperture, real cosine) {
  const real r = cone_sine(aperture), q = fma(REAL(-2.0), aperture, REAL(1.0));
  const real sine = sqrt(at_least((REAL(1.0) - cosine) * (REAL(1.0) + cosine), REAL(0.0)));
  const real w = at_most(at_least(q * cosine / at_least(r * sine, REAL(1e-12)), REAL(-1.0)), REAL(1.0));
  const real share = cone_arc_cosine(-w) + w * sqrt((REAL(1.0) - w) * (REAL(1.0) + w));
  return CONE_INVERSE_PI * r * r * share;
}
SHARED real clip_blend(real aperture, real cosine) {
  const real g = clip_weight(aperture, cosine);
  const real whole = clip_cosine(aperture, cosine) + g * (REAL(1.0) - cosine);
  return g / at_least(whole, REAL(1e-12));
}

/// Solid angle that two cones share; `cosine` of the angle between their axes.
SHARED real overlap_of_apertures(real first, real second, real cosine) {
  const real p = fma(REAL(-2.0), first, REAL(1.0)), q = fma(REAL(-2.0), second, REAL(1.0));
  const real r = cone_sine(first), s = cone_sine(second);
  const real sine = sqrt(at_least((REAL(1.0) - cosine) * (REAL(1.0) + cosine), REAL(0.0)));
  const truth apart = cosine <= fma(p, q, -r * s), within = cosine >= fma(p, q, r * s);
  const real tiny = REAL(1e-9);
  const real angle = cone_arc_cosine(fma(-p, q, cosine) / at_least(r * s, tiny));
  const real from_first = cone_arc_cosine(fma(-p, cosine, q) / at_least(sine * r, tiny));
  const real from_second = cone_arc_cosine(fma(-q, cosine, p) / at_least(sine * s, tiny));
  const real lens = REAL(0.5) * CONE_INVERSE_PI *
                    (REAL(3.141592653589793) - angle - p * from_first - q * from_second);
  const real smaller = at_most(first, second);
  // Two cones wider than 90 degrees may meet on both sides: what they share is at least first + second - 1.
  const real least = at_least(first + second - REAL(1.0), REAL(0.0));
  const real meeting = at_most(at_least(lens, least), smaller);
  return PICK(apart, least, PICK(within, smaller, meeting));
}

SHARED real merge_apertures(real first, real second, real cosine) {
  return first + second - overlap_of_apertures(first, second, cosine);
}

#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
