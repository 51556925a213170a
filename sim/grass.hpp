// Blades of grass: where each is rooted, how long, wide, bent and stiff it is; and how much sky the ground between them
// sees. A function of (field, seed).
#pragma once
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "sim/scene.hpp"
#include "sim/world.hpp"

namespace understory {

/// Half-widths of a blade at its three vertex pairs and their places along it, in units of its base half-width and its
/// length. A triangle strip of 7 vertices, the last one the tip: triangle k has vertices k, k + 1, k + 2.
inline constexpr double blade_pair_place[3] = {0, 0.4, 0.75}, blade_pair_width[3] = {1, 0.85, 0.5};
/// One-sided area of a blade over length times base width (2 half-widths): the trapezoids between these pairs and the
/// tip.
inline constexpr double blade_fullness = 0.4 * (1 + 0.85) / 2 + 0.35 * (0.85 + 0.5) / 2 + 0.25 * 0.5 / 2;

/// A place without grass: the foot of a trunk.
struct Disc {
  glm::dvec2 centre{0};
  double radius = 0;  // m
};

/// Height of the ground, m; nothing where there is none.
using GroundHeight = std::function<std::optional<double>(glm::dvec2)>;

/// Blades of a field, `density` times its area less those on discs or off the ground; neighbours in the list are
/// neighbours in the field, so that runs of blades stay compact. Roots are spread evenly over tiles of 51 blades and
/// uniformly at random within one; a share `clumping` of them gathers in tufts of about 20 blades.
/// Throws Error(invalid_input) if no blade finds ground.
GrassBlades grow_grass(const GrassField& field, std::uint32_t index, std::uint64_t seed, const GroundHeight& ground,
                       const std::vector<Disc>& bare);

/// Mean visibility of the ground over cells about as wide as the grass is high (0.25 m and more, at most 1024 a side).
GroundCover cover_ground(const std::vector<GrassBlades>& fields);

/// Exponential integral E_3(x) = int_1^inf exp(-x t) / t^3 dt, x >= 0. Relative error below 1e-10 for x <= 100; 0
/// beyond, where it is below 4e-46.
double exponential_integral_3(double x);

}  // namespace understory
