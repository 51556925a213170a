// Where the plants stand: by hand, or scattered so that no two are closer than a spacing.
// A function of (placement, seed, stream): what else the scene holds changes nothing.
#pragma once
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "sim/scene.hpp"

namespace understory {

struct PlacedPlant {
  glm::dvec2 at{0};  // m
  double yaw = 0;    // radians, [0, 2 pi) when scattered
  double scale = 1;
  double delay = 0;  // s, [0, longest_plant_delay): neighbours do not sway in step
};

inline constexpr double longest_plant_delay = 2;  // s

/// Whether a plant may stand at a place: there is ground, say.
using Admissible = std::function<bool(glm::dvec2)>;

/// Points of `region` no two closer than `spacing` (m, > 0), with no room left for another to within 30 trials around
/// each: Bridson 2007, "Fast Poisson disk sampling in arbitrary dimensions". In the order in which they were found.
std::vector<glm::dvec2> scatter(const Region& region, double spacing, std::uint64_t seed, std::uint64_t stream,
                                const Admissible& admissible);

/// The plants of one placement. `stream` tells placements apart: stream_of(species, ordinal among its placements).
/// Throws Error(invalid_input) if a spot is not admissible or `count` plants do not fit.
std::vector<PlacedPlant> place(const PlantPlacement& placement, std::uint64_t seed, std::uint64_t stream,
                               const Admissible& admissible);

}  // namespace understory
