// How many of the leaves or blades of a group are drawn at a distance, and how much larger each of them is then, so
// that the group keeps its area: stochastic simplification (Cook, Halstead, Planck, Ryu 2007, "Stochastic
// simplification of aggregate detail", SIGGRAPH, sections 3 to 5). A function of the group and its distance alone.
#pragma once
#include <cstddef>
#include <vector>

namespace understory {

/// Projected sizes below which elements go and the others grow, pixels: roots of a leaf's area, widths of a blade. What
/// is drawn is spread evenly over what it stands for (spread_order.hpp); V then stays within 0.01 of brute force after
/// a filter of 8 x 8 pixels (bench/scale.md).
inline constexpr double leaf_pixels = 0.85, blade_pixels = 0.4;
/// A twig thinner than this on the screen is drawn as one triangle, pixels.
inline constexpr double twig_pixels = 0.5;
/// Share of the drawn units that are on their way in or out, smaller than the others: nothing appears at full size.
inline constexpr double fading_share = 0.25;

/// Area factor of each unit of a group, in the order of drawing; units beyond its end are left out. The factors of a
/// group add up to `units`. `share`: of the units that are to be drawn, above 0; 1 and more: all of them, unchanged.
/// Continuous in `share`. Replaces `factors`.
void thin(std::size_t units, double share, std::vector<float>& factors);

}  // namespace understory
