// An order of points in which every first part lies spread over all of them: leaves and blades that are drawn for the
// others then stand for their own surroundings, which is less noisy than chance.
#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace understory {

/// Numbers of the points, each once: those at places 0, 1/2, 1/4, 3/4, 1/8 ... of a Morton curve through their bounding
/// box (van der Corput's sequence, base 2). `seed` turns the sequence, so that groups do not all begin in one corner.
std::vector<std::size_t> spread_order(const std::vector<glm::vec3>& points, std::uint64_t seed);

}  // namespace understory
