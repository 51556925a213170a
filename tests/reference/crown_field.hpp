// A cell of a crown field in double, in another form than the kernel's: the quadratic in the normal as a symmetric
// matrix, coefficients decoded byte by byte.
#pragma once
#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "kernels/shared/crown_field.h"

namespace understory::reference {

inline double field_coefficient(const std::vector<std::uint32_t>& cells, std::size_t cell, std::size_t number) {
  const std::uint32_t word = cells[FIELD_WORDS * cell + number / 4];
  const int byte = static_cast<int>(word / (1u << (8 * (number % 4)))) & 255;
  return byte < 128 ? byte : byte - 256;
}

/// V. `p`: m, prototype frame; `n`: unit, prototype frame.
inline double crown_field(const CrownFieldGrid& grid, const std::vector<std::uint32_t>& cells, glm::dvec3 p,
                          glm::dvec3 n) {
  const glm::dvec3 place = (p - glm::dvec3(grid.low_x, grid.low_y, grid.low_z)) * double(grid.cells_per_metre);
  const glm::dvec3 last = glm::dvec3(grid.columns, grid.rows, grid.layers) - 1.0;
  const glm::dvec3 at = glm::min(glm::max(glm::floor(place), glm::dvec3(0)), last);
  const glm::dvec3 q = glm::min(glm::max((place - at - 0.5) * 2.0, glm::dvec3(-1)), glm::dvec3(1));
  const auto cell = static_cast<std::size_t>(grid.first_cell) +
                    static_cast<std::size_t>(at.x + double(grid.columns) * (at.y + double(grid.rows) * at.z));
  const auto c = [&](std::size_t number) { return field_coefficient(cells, cell, number); };
  const glm::dmat3 quadratic(c(8), c(4) / 2, c(6) / 2, c(4) / 2, -c(8), c(5) / 2, c(6) / 2, c(5) / 2, c(7));
  const double steps = c(0) - c(7) / 3 + glm::dot(glm::dvec3(c(1), c(2), c(3)), n) + glm::dot(n, quadratic * n) +
                       glm::dot(glm::dvec3(c(9), c(10), c(11)), q);
  return std::clamp(steps / 100, 0.0, 1.0);
}

}  // namespace understory::reference
