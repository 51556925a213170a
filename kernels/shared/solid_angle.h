// What share of a fragment's sky an opaque sphere blocks, in three forms. c = (x, y, z): the sphere's centre from the
// fragment, d = |c|, s = c.n its height above the tangent plane, r its radius; all m.
//   solid_angle         Hegeman et al. 2006 eq. 7-8: pi (r/d)^2 / 2 pi; near V_u, knows no tangent plane
//   solid_angle_exact   V_u: the cone 2 pi (1 - sqrt(1 - (r/d)^2)) clipped by the tangent plane, over 2 pi
//   solid_angle_cosine  V_c: the exact form factor of the sphere clipped by the tangent plane
// With t = sqrt(d^2 - r^2), k = sqrt(r^2 - s^2), A = atan(s t / (d k)), where the plane cuts the sphere (|s| < r):
//   exact   1/2 + atan(s/k)/pi - (t/d) (1/2 + A/pi)           Gauss-Bonnet on the clipped cap
//   cosine  [s r^2/d^3 (pi/2 + A) - k t/d^2 + atan(k/t)] / pi   Snyder 1996, MSR-TR-96-11, spherical source
// At d <= r (validity code 16) the paper's form is capped at 1; the others take their limit at d = r and go linearly
// to 1 at the centre, so that they stay continuous. tests/kernels/solid_angle_test.cpp: error below 2e-6.
#ifndef UNDERSTORY_SOLID_ANGLE_H
#define UNDERSTORY_SOLID_ANGLE_H

#include "kernels/shared/arc_tangent.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

#define INVERSE_PI REAL(0.3183098861837907)

/// A sphere as a fragment sees it; lengths in m.
typedef struct {
  real distance, height;     // d >= 1e-12; s within [-d, d]
  real radius;               // r, at most d: the contact's limit stands for the inside
  real inverse_distance;     // 1/d
  real inside;               // d/r within the sphere, 1 outside
} SphereView;

SHARED SphereView view_sphere(real x, real y, real z, real a, real b, real c, real radius) {
  SphereView view;
  // A position that is not a number stays one, and blocks nothing in the end.
  const real length_squared = fma(x, x, fma(y, y, z * z));
  const real square = PICK(length_squared < REAL(1e-24), REAL(1e-24), length_squared);
  view.distance = sqrt(square);
  view.inverse_distance = REAL(1.0) / view.distance;
  view.height = at_most(at_least(fma(x, a, fma(y, b, z * c)), -view.distance), view.distance);
  view.radius = at_most(radius, view.distance);
  view.inside = PICK(view.distance < radius, view.distance / at_least(radius, REAL(1e-12)), REAL(1.0));
  return view;
}

/// atan(s/k) and the like: odd in its first argument, whose sign may be either.
SHARED real signed_arc_tangent(real y, real x) {
  const real angle = arc_tangent(fabs(y), x);
  return PICK(y < REAL(0.0), -angle, angle);
}

/// sqrt(u^2 - v^2) for u >= |v|, 0 beyond; the product keeps the digits that the squares lose.
SHARED real leg(real u, real v) { return sqrt(at_least((u - v) * (u + v), REAL(0.0))); }

/// A share within [0, 1], continued to the sphere's centre; NaN blocks nothing.
SHARED real blocked_share(real share, real inside) {
  const real open = REAL(1.0) - at_most(at_least(share, REAL(0.0)), REAL(1.0));
  return fma(-inside, open, REAL(1.0));
}

/// Validity code 16: the fragment lies within the sphere.
SHARED truth sphere_too_close(real x, real y, real z, real radius) {
  return fma(x, x, fma(y, y, z * z)) <= radius * radius;
}

SHARED real solid_angle(real x, real y, real z, real a, real b, real c, real radius) {
  const SphereView view = view_sphere(x, y, z, a, b, c, radius);
  const real ratio = radius * view.inverse_distance;
  return at_most(at_least(REAL(0.5) * ratio * ratio, REAL(0.0)), REAL(1.0));
}

SHARED real solid_angle_exact(real x, real y, real z, real a, real b, real c, real radius) {
  const SphereView view = view_sphere(x, y, z, a, b, c, radius);
  const real s = view.height, r = view.radius;
  const real ratio = r * view.inverse_distance;
  const real cosine = leg(view.distance, r) * view.inverse_distance;  // of the cone's half-angle
  real share = PICK(s > REAL(0.0), ratio * ratio / (REAL(1.0) + cosine), REAL(0.0));
  const truth cut = fabs(s) < r;
  if (ANY(cut)) {
    const real k = leg(r, s);
    const real lean = signed_arc_tangent(s * cosine, k), rise = signed_arc_tangent(s, k);
    const real clipped = fma(-cosine, fma(lean, INVERSE_PI, REAL(0.5)), fma(rise, INVERSE_PI, REAL(0.5)));
    share = PICK(cut, clipped, share);
  }
  return blocked_share(share, view.inside);
}

SHARED real solid_angle_cosine(real x, real y, real z, real a, real b, real c, real radius) {
  const SphereView view = view_sphere(x, y, z, a, b, c, radius);
  const real s = view.height, r = view.radius;
  const real ratio = r * view.inverse_distance;
  const real whole = ratio * ratio * (s * view.inverse_distance);
  real share = whole;
  const truth cut = fabs(s) < r;
  if (ANY(cut)) {
    const real cosine = leg(view.distance, r) * view.inverse_distance, k = leg(r, s);
    const real lean = signed_arc_tangent(s * cosine, k);
    const real edge = arc_tangent(k * view.inverse_distance, cosine);
    const real clipped = fma(whole, fma(lean, INVERSE_PI, REAL(0.5)),
                             INVERSE_PI * fma(-k * view.inverse_distance, cosine, edge));
    share = PICK(cut, clipped, share);
  }
  return blocked_share(share, view.inside);
}

#undef INVERSE_PI
#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
