// Visibility in a crown of even foliage: the mean of exp(-k L(x, w)) over the hemisphere of n, cosine-weighted (V_c),
// L the way from x through the crown's shell (FORMULAS.md, "What was measured"). Evaluates what sim/transmittance_fit
// fits once for each shell, in the frame where the shell is the unit sphere: p the fragment, q = |p|, g the shell's
// outward normal there in world axes as long as q, s = n.g (p.n for a sphere), R the geometric mean radius.
//   within    V = e^-d [P0 + P1 s + P2 s^2 + P4 s^4 + P6 s^6],  d = 3/8 k R (1 - q^2) a
//             P_j: polynomials of degree 4 in z = h/(1 + bend h), h = sqrt(1 - q^2): half the chord across.
//             The odd part in n is the net flux, n.F, thus linear in s: no other odd power.
//   outside   V = 1 - [E(s^2, sqrt(1 - 1/q^2)) - O s/2]/q^3 where the tangent plane cuts the shell, 1 + O s/q^3 where
//             all of it is above: what the sphere's disc blocks, O = 1 - its mean transmittance.
//   ellipsoid a = sqrt(q/|M^T p| / R), M the map to the unit sphere: the way out is shorter across than along.
//   horizon   (SKY_DOME) light w that leaves is b0 + b1 w.g + b2 (w.g)^2 to second order, whose mean over the lune of
//             directions above the horizon is closed (lune.h); b follow from P0, P1, P2, so the fit has no more powers.
//             Outside, of what the disc blocks, the part above the horizon counts; near the shell the fit's value on it
//             takes the place of that estimate, fading as q^-8, so that V is continuous there.
#ifndef UNDERSTORY_CROWN_TRANSMITTANCE_H
#define UNDERSTORY_CROWN_TRANSMITTANCE_H

#include "kernels/shared/ellipsoid_cap.h"
#include "kernels/shared/lune.h"
#include "kernels/shared/open_dome.h"
#include "kernels/shared/transmittance_shell.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

/// Where a fragment is in a shell.
typedef struct {
  real square;   // q^2, at least 1e-30
  real along;    // s
  real rise;     // g.z
  real stretch;  // a, 1 for a sphere
} ShellPlace;

/// c0 + c1 z + ... + c4 z^4
SHARED real quartic(MATRIX c, real z) {
  return fma(fma(fma(fma((real)(c[4]), z, (real)(c[3])), z, (real)(c[2])), z, (real)(c[1])), z, (real)(c[0]));
}

/// `offset`: fragment from the shell's centre, m; `to_unit`: TransmittanceShell's; `radius`: R, m.
SHARED ShellPlace place_in_shell(Direction offset, Direction normal, MATRIX to_unit, ELEMENT radius) {
  const Direction first = {(real)(to_unit[0]), (real)(to_unit[1]), (real)(to_unit[2])};
  const Direction second = {(real)(to_unit[4]), (real)(to_unit[5]), (real)(to_unit[6])};
  const Direction third = {(real)(to_unit[8]), (real)(to_unit[9]), (real)(to_unit[10])};
  const Direction p = to_unit_sphere(offset, first, second, third);
  // R M^T p: as long as q for a sphere.
  Direction g;
  g.x = (real)(radius)*fma(first.x, p.x, fma(second.x, p.y, third.x * p.z));
  g.y = (real)(radius)*fma(first.y, p.x, fma(second.y, p.y, third.y * p.z));
  g.z = (real)(radius)*fma(first.z, p.x, fma(second.z, p.y, third.z * p.z));
  ShellPlace place;
  place.square = at_least(dot_product(p, p), REAL(1e-30));
  const real stretch = sqrt(place.square / at_least(dot_product(g, g), REAL(1e-30)));
  place.stretch = sqrt(stretch);
  place.along = stretch * dot_product(g, normal);
  place.rise = stretch * g.z;
  return place;
}

/// The place in a sphere: `inverse`: 1/R, 1/m. The same as above in a third of the operations.
SHARED ShellPlace place_in_sphere(Direction offset, Direction normal, ELEMENT inverse) {
  ShellPlace place;
  place.square = at_least(dot_product(offset, offset) * ((real)(inverse) * (real)(inverse)), REAL(1e-30));
  place.stretch = REAL(1.0);
  place.along = dot_product(offset, normal) * (real)(inverse);
  place.rise = offset.z * (real)(inverse);
  return place;
}

/// e^-d and z of a fragment within.
SHARED real crown_decay(ShellPlace place, ELEMENT optical, ELEMENT bend, PRIVATE real* z) {
  const real gap = at_least(REAL(1.0) - place.square, REAL(0.0)), half_chord = sqrt(gap);
  *z = half_chord / fma((real)(bend), half_chord, REAL(1.0));
  return exp_minus(at_least(REAL(0.375) * (real)(optical)*place.stretch * gap, REAL(0.0)));
}

/// Within the shell, `sky: sphere`.
SHARED real transmittance_within(ShellPlace place, ELEMENT optical, ELEMENT bend, MATRIX within) {
  real z;
  const real decay = crown_decay(place, optical, bend, &z), v = place.along * place.along;
  real sum = fma(quartic(within + 20, z), v, quartic(within + 15, z));
  sum = fma(fma(sum, v, quartic(within + 10, z)), v, quartic(within, z));
  return decay * fma(quartic(within + 5, z), place.along, sum);
}

/// Mean over the lune of light with the coefficients P0, P1, P2. `c`: n.z.
SHARED real lune_mean(ShellPlace place, real c, real level, real slope, real curve) {
  real sum = fma(-curve, place.square, level) * open_dome(c);
  sum = fma(REAL(1.5) * slope, lune_first(place.along, place.rise, c), sum);
  return fma(REAL(4.0) * curve, lune_second(place.along, place.rise, place.square, c), sum);
}

/// Within the shell, `sky: dome`. `c`: n.z; `within`: fitted with P4 = P6 = 0, not read.
SHARED real transmittance_under_dome(ShellPlace place, real c, ELEMENT optical, ELEMENT bend, MATRIX within) {
  real z;
  const real decay = crown_decay(place, optical, bend, &z);
  return decay * lune_mean(place, c, quartic(within, z), quartic(within + 5, z), quartic(within + 10, z));
}

/// What a crown blocks of the hemisphere of a fragment outside it, `sky: sphere`.
SHARED real blocked_outside(ShellPlace place, ELEMENT opacity, MATRIX outside) {
  const real inverse = REAL(1.0) / sqrt(at_least(place.square, REAL(1.0)));
  const real cone = sqrt(at_least(fma(-inverse, inverse, REAL(1.0)), REAL(0.0)));
  const real s = at_least(at_most(place.along, REAL(1.0)), REAL(-1.0)), v = s * s;
  real even = fma(quartic(outside + 20, cone), v, quartic(outside + 15, cone));
  even = fma(fma(fma(even, v, quartic(outside + 10, cone)), v, quartic(outside + 5, cone)), v, quartic(outside, cone));
  const real cut = fma(REAL(-0.5) * (real)(opacity), s, even);
  const real all = at_least(-place.along, REAL(0.0)) * (real)(opacity);
  return PICK(fabs(place.along) < REAL(1.0), at_least(cut, REAL(0.0)), all) * (inverse * inverse * inverse);
}

/// The same on the shell, of which `place` tells the direction only: the polynomials' first coefficients are left.
SHARED real blocked_at_rim(ShellPlace place, ELEMENT opacity, MATRIX outside) {
  const real s = at_least(at_most(place.along, REAL(1.0)), REAL(-1.0)), v = s * s;
  real even = fma((real)(outside[20]), v, (real)(outside[15]));
  even = fma(fma(fma(even, v, (real)(outside[10])), v, (real)(outside[5])), v, (real)(outside[0]));
  return at_least(fma(REAL(-0.5) * (real)(opacity), s, even), REAL(0.0));
}

/// Of blocked_outside, the part above the horizon. Tangent plane and horizon leave the shares h and z of the disc's
/// width; both leave h z when they cross at a right angle, the lesser when they are one, h + z - 1 when they face each
/// other (the Frechet bounds of joint shares), and what c = n.z puts between.
SHARED real share_above_horizon(ShellPlace place, real c) {
  const real h = as_visibility(fma(REAL(-0.5), place.along, REAL(0.5)));
  const real z = as_visibility(fma(REAL(-0.5), place.rise, REAL(0.5)));
  const real crossing = h * z, most = at_most(h, z), least = at_least(h + z - REAL(1.0), REAL(0.0));
  const real bound = PICK(c > REAL(0.0), most, least);
  return fma(fabs(c), bound - crossing, crossing) / at_least(h, REAL(1e-6));
}

/// What a crown blocks of what a fragment outside it sees of the dome. `open`: of the dome.
SHARED real blocked_under_dome(ShellPlace place, real c, real open, ELEMENT opacity, MATRIX within, MATRIX outside) {
  const real inverse = REAL(1.0) / sqrt(at_least(place.square, REAL(1.0)));
  ShellPlace rim = place;
  rim.square = REAL(1.0);
  rim.along = place.along * inverse;
  rim.rise = place.rise * inverse;
  const real seen = lune_mean(rim, c, (real)(within[0]), (real)(within[5]), (real)(within[10]));
  const real estimate = blocked_at_rim(rim, opacity, outside) * share_above_horizon(rim, c);
  const real rest = open - at_least(seen, REAL(0.0)) - estimate;
  const real p = inverse * inverse, square = p * p;
  return fma(rest, square * square, blocked_outside(place, opacity, outside) * share_above_horizon(place, c));
}

#ifndef __OPENCL_C_VERSION__

/// V of one shell, centred at the origin, in double: what the kernel computes.
inline double crown_transmittance(const TransmittanceShell& shell, double x, double y, double z, double a, double b,
                                  double c, bool dome) {
  const Direction offset = {x, y, z}, normal = {a, b, c};
  const ShellPlace place = place_in_shell(offset, normal, shell.to_unit, shell.radius);
  double v = dome
                 ? open_dome(c) - blocked_under_dome(place, c, open_dome(c), shell.opacity, shell.within, shell.outside)
                 : 1 - blocked_outside(place, shell.opacity, shell.outside);
  if (place.square <= 1)
    v = dome ? transmittance_under_dome(place, c, shell.optical, shell.bend, shell.within)
             : transmittance_within(place, shell.optical, shell.bend, shell.within);
  return as_visibility(double(shell.near_share) * at_least(v, 0));
}

}  // namespace understory
#endif
#endif
