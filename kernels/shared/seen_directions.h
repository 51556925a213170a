// The union of cones as what they leave of a few directions: SEEN_DIRECTIONS of them, cosine-distributed about the normal,
// each standing for the same share of V_c. A cone covers the directions in it, with an edge as soft as their spacing, and is
// then scaled so that alone it blocks exactly its own cosine-weighted share. What several cones cover lies between what the
// least open of them lets through (each hides behind it) and the product of what each lets through (by chance): the parts
// of a body hide behind one another more than chance has it. Opaque cones count once; the order does not matter.
// A running cone (shared/running_cone.h) has to take two cones that lie apart for one that is as wide as both.
#ifndef UNDERSTORY_SEEN_DIRECTIONS_H
#define UNDERSTORY_SEEN_DIRECTIONS_H

#include "kernels/shared/cone.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
#define SEEN_TABLE inline constexpr float
#else
#define SEEN_TABLE constant float
#endif

#define SEEN_DIRECTIONS 16

/// Point i of a spiral: radius sqrt((i + 1/2) / 16), turned by i golden angles, lifted onto the hemisphere. x, y, z each.
SEEN_TABLE seen_directions[3 * SEEN_DIRECTIONS] = {
    0.176776695f, 0.000000000f, 0.984250984f,
    -0.225772188f, 0.206825818f, 0.951971638f,
    0.034558052f, -0.393771179f, 0.918558654f,
    0.284571220f, 0.371172764f, 0.883883476f,
    -0.522223187f, -0.092373929f, 0.847791248f,
    0.494695392f, -0.314684715f, 0.810092587f,
    -0.165465927f, 0.615525001f, 0.770551750f,
    -0.315561468f, -0.607594404f, 0.728868987f,
    0.684642162f, 0.250030219f, 0.684653197f,
    -0.712256086f, 0.294008958f, 0.637377439f,
    0.343354499f, -0.733728620f, 0.586301970f,
    0.253730241f, 0.808931990f, 0.530330086f,
    -0.764745892f, -0.443185876f, 0.467707173f,
    0.897133984f, -0.197232390f, 0.395284708f,
    -0.547506905f, 0.778772232f, 0.306186218f,
    -0.126486773f, -0.976089697f, 0.176776695f};

/// Weight of the least open cone, that of the product being the rest: 1/2 is best for exact shares, less where grids
/// end early and lose some (bench/grids.md).
#define SEEN_NESTED REAL(0.3333333333333333)

typedef struct {
  real product[SEEN_DIRECTIONS], least[SEEN_DIRECTIONS];  // of each direction, what is left: [0, 1]
} SeenDirections;

/// Two directions that span the plane of a unit normal with it; continuous but where its z changes sign (Duff et al. 2017,
/// "Building an Orthonormal Basis, Revisited").
typedef struct {
  real x[3], y[3];
} Tangents;

SHARED Tangents tangents_of(real a, real b, real c) {
  const real side = PICK(c < REAL(0.0), REAL(-1.0), REAL(1.0));
  const real scale = REAL(-1.0) / (side + c), mixed = a * b * scale;
  const Tangents t = {{fma(side * a * a, scale, REAL(1.0)), side * mixed, -side * a}, {mixed, fma(b * b, scale, side), -b}};
  return t;
}

SHARED void see_all(PRIVATE SeenDirections* seen) {
  for (int i = 0; i < SEEN_DIRECTIONS; ++i) seen->product[i] = seen->least[i] = REAL(1.0);
}

/// `share`: of V_c that the cone blocks alone above the plane of the normal (a, b, c); 0: it is left out.
SHARED void cover(PRIVATE SeenDirections* seen, const Tangents t, real a, real b, real c, const Cone cone, real share) {
  const real x = fma(cone.x, t.x[0], fma(cone.y, t.x[1], cone.z * t.x[2]));
  const real y = fma(cone.x, t.y[0], fma(cone.y, t.y[1], cone.z * t.y[2]));
  const real z = fma(cone.x, a, fma(cone.y, b, cone.z * c));
  // From 0 to 1 over an eighth of a radian to either side of the edge: cos(h - d) - cos(h + d) = 2 sin h sin d, and a
  // little more for the narrowest. Softer edges count alike cones twice, sharper ones see the directions singly.
  const real inverse = REAL(1.0) / fma(REAL(0.25), cone_sine(cone.aperture), REAL(0.015625));
  const real at_edge = fma(fma(REAL(2.0), cone.aperture, REAL(-1.0)), inverse, REAL(0.5));
  real covered[SEEN_DIRECTIONS], sum = REAL(0.0);
  for (int i = 0; i < SEEN_DIRECTIONS; ++i) {
    const real lean = fma(x, (real)(seen_directions[3 * i]),
                          fma(y, (real)(seen_directions[3 * i + 1]), z * (real)(seen_directions[3 * i + 2])));
    covered[i] = at_most(at_least(fma(lean, inverse, at_edge), REAL(0.0)), REAL(1.0));
    sum += covered[i];
  }
  // Too much: every direction less of it. Too little: every direction leaves less.
  const real mean = cone.opacity * sum * REAL(0.0625);
  const real less = share / at_least(mean, REAL(1e-9)), through = (REAL(1.0) - share) / at_least(REAL(1.0) - mean, REAL(1e-9));
  const truth much = mean >= share;
  const real factor = cone.opacity * PICK(much, less, through), more = PICK(much, REAL(0.0), REAL(1.0) - through);
  for (int i = 0; i < SEEN_DIRECTIONS; ++i) {
    const real blocked = fma(covered[i], factor, more);
    seen->product[i] = fma(-seen->product[i], blocked, seen->product[i]);
    seen->least[i] = at_most(seen->least[i], REAL(1.0) - blocked);
  }
}

/// V_c.
SHARED real share_seen(PRIVATE const SeenDirections* seen) {
  real product = REAL(0.0), least = REAL(0.0);
  for (int i = 0; i < SEEN_DIRECTIONS; ++i) product += seen->product[i], least += seen->least[i];
  return fma(SEEN_NESTED, least - product, product) * REAL(0.0625);
}

#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
