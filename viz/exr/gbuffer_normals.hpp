// Normals for a G-buffer that has none, from its positions.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "sim/frame.hpp"

namespace understory {

/// Cross product of the steps to the nearer neighbour along each direction of the image; either side of the surface,
/// and not unit. 0 where `surface` is 0; where a pixel has no neighbour along a direction, towards `eye`.
std::array<Plane, 3> normals_from_positions(int width, int height, const std::array<Plane, 3>& position,
                                            const std::vector<std::uint8_t>& surface, glm::dvec3 eye);

}  // namespace understory
