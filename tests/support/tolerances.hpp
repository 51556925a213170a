// How far results may be from the truth, each with its reason. Absolute, of visibilities in [0, 1] unless said.
#pragma once

namespace understory::tolerance {

// kernels/shared/exp_minus.h: minimax polynomial of 9.2e-8, and the rounding of x log2(e), x/2^24 relative, times
// exp(-x) x <= 1/e.
inline constexpr double exp_minus = 2e-7;
// The same relative to the result: 87 log2(e) is rounded to 24 bits, an error of 4e-6 in the exponent of 2.
inline constexpr double exp_minus_relative = 8e-6;
// kernels/shared/arc_tangent.h: minimax polynomial of 2.5e-7 rad and two roundings near pi/2.
inline constexpr double arc_tangent = 5e-7;
// Eq. 6: |x e^-x| <= 1/e times the relative error of f Vcap, about ten roundings of 6e-8, and the cap height's
// cancellation R - s, one rounding of s <= R relative to h, to the power of 4, where h is still large enough to matter.
inline constexpr double crown = 4e-6;
// crown-transmittance: of sums of up to 25 terms below 4 with alternating signs, and of the three products of shells.
inline constexpr double crown_transmittance = 3e-5;
// 240 x 240 directions over a step of the transmittance at the horizon of the densest crown.
inline constexpr double crown_quadrature = 3e-4;
// The same in the ellipsoid's scaled space: six more roundings in front of it, scaled by up to 4 by flat ellipsoids.
inline constexpr double ellipsoid_crown = 2e-5;
// Two roundings of numbers below 1.
inline constexpr double grass = 3e-7;
inline constexpr double open_dome = 1.2e-7;
// Light among grass: a place between nodes is known to some roundings of a coordinate of up to 5 m, 1e-6 m, and there
// are up to 15 nodes a metre that differ by up to 0.5, each number times at most 2.
inline constexpr double grass_layer = 1.5e-5;
// Bilinear: cell coordinates up to 100 are rounded to 24 bits, times a slope of at most 1 per cell.
inline constexpr double ground_cover = 2e-5;
// solid_angle_cosine: least-maximum fits of 8.5e-6 from 4 radii on and of 1.0e-5 from 1.5 on, and roundings.
inline constexpr double solid_angle = 1.5e-5;
// A product of up to 40 factors, most of them far from where the fits err most.
inline constexpr double solid_angle_product = 4e-5;
// Six trilinear look-ups: positions of some metres are rounded to 24 bits, and occlusion changes by up to 1 per sample.
inline constexpr double grid = 2e-5;
// The same, then closed forms of arc tangents; a small cone's direction comes from few of its 8-bit units.
inline constexpr double grid_cone = 2e-4;
// Product of six numbers in [0, 1].
inline constexpr double combine = 5e-7;
// Quadrature over a cap's polar angle, 4000 nodes: its own error, found by doubling them.
inline constexpr double quadrature = 1e-7;
// Obscurance: depths relative to the fragment keep about 1e-6 of the depth, here a dozen radii; lengths of lines seen
// at a slant, up to 1/cos 85 degrees of them, sum up to it; angles of the rotation within 4e-6.
inline constexpr double obscurance = 1e-3;
// A million directions, one per cell of a 1000 x 1000 grid of equal shares: the boundary crosses about 3000 cells.
inline constexpr double ray_counting = 5e-4;
// Rigid motion and scaling, computed with the same float kernel from rounded positions some tens of metres away.
inline constexpr double moved = 2e-5;

}  // namespace understory::tolerance
