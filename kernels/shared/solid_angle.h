// What share of a fragment's sky an opaque sphere blocks, in three forms. Lengths are in units of the sphere's radius;
// (x, y, z) is the sphere's centre from the fragment, (a, b, c) the unit normal; d the distance, s the centre's height
// above the tangent plane, p = 1/d^2, t = sqrt(d^2 - 1), k = sqrt(1 - s^2), A = atan(s t / (d k)).
//   solid_angle         Hegeman et al. 2006 eq. 7-8: pi p / 2 pi; near V_u, knows no tangent plane
//   solid_angle_exact   V_u: the cone 2 pi (1 - t/d) clipped by the tangent plane, over 2 pi; where the plane cuts the
//                       sphere 1/2 + atan(s/k)/pi - (t/d) (1/2 + A/pi), by Gauss-Bonnet on the clipped cap
//   solid_angle_cosine  V_c: the form factor of the sphere clipped by the tangent plane: s/d^3 where the sphere is above
//                       it, where the plane cuts it [s/d^3 (pi/2 + A) - k t/d^2 + atan(k/t)] / pi
//                       (Snyder 1996, Area light sources for real-time graphics, MSR-TR-96-11)
// At d <= 1 (validity code 16) the paper's form is capped at 1; the others take their limit at d = 1 and go linearly
// to 1 at the centre, so that they stay continuous. Error below 1.5e-5 (tests/kernels/solid_angle_test.cpp).
#ifndef UNDERSTORY_SOLID_ANGLE_H
#define UNDERSTORY_SOLID_ANGLE_H

#include "kernels/shared/arc_tangent.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

#define INVERSE_PI REAL(0.3183098861837907)

/// d^2. A position that is not a number stays one, and blocks nothing in the end.
SHARED real distance_squared(real x, real y, real z) { return fma(x, x, fma(y, y, z * z)); }

/// sqrt(u^2 - v^2) for u >= |v|, 0 beyond; the product keeps the digits that the squares lose.
SHARED real leg(real u, real v) { return sqrt(at_least((u - v) * (u + v), REAL(0.0))); }

/// atan(y/x) for x >= 0 and y of either sign.
SHARED real signed_arc_tangent(real y, real x) {
  const real angle = arc_tangent(fabs(y), x);
  return PICK(y < REAL(0.0), -angle, angle);
}

/// Within [0, 1], and nothing for what is not a number.
SHARED real as_share(real share) { return at_most(at_least(share, REAL(0.0)), REAL(1.0)); }

/// Continues the share at the sphere's surface to 1 at its centre.
SHARED real share_inside(real share, real distance) {
  return PICK(distance < REAL(1.0), fma(-distance, REAL(1.0) - as_share(share), REAL(1.0)), share);
}

SHARED real unit_solid_angle(real s, real square) {
  (void)s;  // takes what the others take
  return as_share(REAL(0.5) / square);
}

/// Where the plane cuts the sphere, or the fragment lies within it.
SHARED real cut_solid_angle_exact(real height, real square) {
  const real distance = at_least(sqrt(square), REAL(1e-12));
  const real s = at_most(at_least(height, -distance), distance), r = at_most(REAL(1.0), distance);
  const real cosine = leg(distance, r) / distance, k = leg(r, s);
  const real lean = signed_arc_tangent(s * cosine, k), rise = signed_arc_tangent(s, k);
  const real share = fma(-cosine, fma(lean, INVERSE_PI, REAL(0.5)), fma(rise, INVERSE_PI, REAL(0.5)));
  return share_inside(share, distance);
}

SHARED real unit_solid_angle_exact(real s, real square) {
  const real p = REAL(1.0) / square;
  const real whole = p / (REAL(1.0) + sqrt(at_least(REAL(1.0) - p, REAL(0.0))));
  const truth cut = (fabs(s) < REAL(1.0)) | (square < REAL(1.0));
  real share = PICK(s > REAL(0.0), whole, REAL(0.0));
  if (ANY(cut)) share = PICK(cut, cut_solid_angle_exact(s, square), share);
  return as_share(share);
}

/// Where the plane cuts the sphere and the fragment is near it, or within it: the closed form. `inverse`: 1/d.
SHARED real near_cut_cosine(real height, real square, real inverse) {
  const real distance = square * inverse, s = at_most(at_least(height, -distance), distance);
  const real t = sqrt(at_least(square - REAL(1.0), REAL(0.0))), k = leg(REAL(1.0), s);
  const real p = inverse * inverse, whole = p * inverse * s;
  const real lean = signed_arc_tangent(s * t, distance * k), edge = arc_tangent(k, t);
  const real cut = fma(whole, fma(lean, INVERSE_PI, REAL(0.5)), INVERSE_PI * fma(-k * t, p, edge));
  // At d = 1 it is (1 + s)/2; from there it goes linearly to 1 at the centre.
  return PICK(square < REAL(1.0), fma(REAL(0.5), s - distance, REAL(1.0)), cut);
}

// Where the plane cuts the sphere, |s| < 1, the closed form is s/(2 d^3) plus d^-3 times a part even in s; least-maximum
// fits of that part over v = s^2 and p take a fraction of the closed form's time.

/// d >= 4: error 8.5e-6. `cube`: 1/d^3.
SHARED real distant_cut_cosine(real s, real cube) {
  const real v = s * s;
  const real even = fma(fma(REAL(-0.02588959), v, REAL(0.31065305)), v, REAL(0.21577735));
  return cube * fma(REAL(0.5), s, even);
}

/// d >= 1.5: error 1.0e-5.
SHARED real close_cut_cosine(real s, real p, real cube) {
  const real v = s * s;
  real zeroth = fma(REAL(0.000777913753), v, REAL(-0.00374477773));
  zeroth = fma(fma(fma(zeroth, v, REAL(-0.0286436851)), v, REAL(0.318303257)), v, REAL(0.213446591));
  real first = fma(REAL(-0.0135558495), v, REAL(-0.0296070418));
  first = fma(fma(fma(first, v, REAL(0.149480718)), v, REAL(-0.157503297)), v, REAL(0.0508066654));
  real second = fma(REAL(-0.0311828724), v, REAL(0.153302955));
  second = fma(fma(fma(second, v, REAL(-0.140697678)), v, REAL(-0.0522853237)), v, REAL(0.0711808654));
  return cube * fma(REAL(0.5), s, fma(fma(second, p, first), p, zeroth));
}

/// Negative where the sphere is below the plane. `inverse`: 1/d.
SHARED real close_share_cosine(real s, real inverse) {
  const real p = inverse * inverse, cube = p * inverse;
  return PICK(fabs(s) < REAL(1.0), close_cut_cosine(s, p, cube), s * cube);
}

SHARED real unit_solid_angle_cosine(real s, real square) {
  const real inverse = REAL(1.0) / sqrt(at_least(square, REAL(1e-24)));
  real share = close_share_cosine(s, inverse);
  const truth near = (square < REAL(2.25)) & (fabs(s) < REAL(1.0));
  if (ANY(near)) share = PICK(near, near_cut_cosine(s, square, inverse), share);
  return at_least(share, REAL(0.0));
}

// The same, without a branch, where the fragment is at least 4 radii (distant) or 1.5 radii (close) away.

SHARED real distant_unit_solid_angle(real s, real square) { return unit_solid_angle(s, square); }
SHARED real close_unit_solid_angle(real s, real square) { return unit_solid_angle(s, square); }
SHARED real distant_unit_solid_angle_exact(real s, real square) { return unit_solid_angle_exact(s, square); }
SHARED real close_unit_solid_angle_exact(real s, real square) { return unit_solid_angle_exact(s, square); }

SHARED real distant_unit_solid_angle_cosine(real s, real square) {
  const real cube = REAL(1.0) / (square * sqrt(square));
  return at_least(PICK(fabs(s) < REAL(1.0), distant_cut_cosine(s, cube), s * cube), REAL(0.0));
}
SHARED real close_unit_solid_angle_cosine(real s, real square) {
  return at_least(close_share_cosine(s, REAL(1.0) / sqrt(square)), REAL(0.0));
}

/// Height of a sphere's centre (x, y, z) above the tangent plane of a fragment of normal (a, b, c).
SHARED real height_above_plane(real x, real y, real z, real a, real b, real c) { return fma(x, a, fma(y, b, z * c)); }

/// The shares of a sphere of `radius` > 0, lengths in m.
SHARED real solid_angle(real x, real y, real z, real a, real b, real c, real radius) {
  x = x / radius, y = y / radius, z = z / radius;
  return unit_solid_angle(height_above_plane(x, y, z, a, b, c), distance_squared(x, y, z));
}

SHARED real solid_angle_exact(real x, real y, real z, real a, real b, real c, real radius) {
  x = x / radius, y = y / radius, z = z / radius;
  return unit_solid_angle_exact(height_above_plane(x, y, z, a, b, c), distance_squared(x, y, z));
}

SHARED real solid_angle_cosine(real x, real y, real z, real a, real b, real c, real radius) {
  x = x / radius, y = y / radius, z = z / radius;
  return unit_solid_angle_cosine(height_above_plane(x, y, z, a, b, c), distance_squared(x, y, z));
}

#undef INVERSE_PI
#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
