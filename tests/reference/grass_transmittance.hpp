// The light among grass in double, another way than the kernel: the eight nodes around a place one after the other,
// each asked for its own visibility, and these weighted. Linear in the node's numbers, so the order does not matter.
#pragma once
#include <algorithm>
#include <cmath>

#include "sim/grass_layer.hpp"
#include "tests/reference/grass_height.hpp"

namespace understory::reference {

inline double grass_light(const LayerLight& light, glm::dvec3 n) {
  const double zonal[] = {double(light.above) + double(light.below),
                          double(light.above) + double(light.zenith) - double(light.below), double(light.zenith)};
  return zonal[0] + zonal[1] * n.z + zonal[2] * n.z * n.z + double(light.x) * n.x + double(light.y) * n.y;
}

/// Column of a node, and height of the ground, both by bilinear weights; `visit(column, weight)`.
template <class Visit>
void each_column(const GrassLayer& layer, glm::dvec2 p, const Visit& visit) {
  const glm::dvec2 cells(layer.columns, layer.rows);
  const glm::dvec2 at = (p - layer.extent.low) / (layer.extent.high - layer.extent.low) * cells - 0.5;
  for (std::uint32_t row = 0; row < layer.rows; ++row)
    for (std::uint32_t column = 0; column < layer.columns; ++column) {
      const double weight = std::max(0.0, 1 - std::abs(at.x - column)) * std::max(0.0, 1 - std::abs(at.y - row));
      if (weight > 0) visit(row * layer.columns + column, weight);
    }
}

/// V_c at `p`, relative to the origin, for the unit normal `n`, over the open dome's (at least 0.01) unless
/// `open_below`; 1 beside the outer columns and above the grass.
inline double grass_transmittance(const GrassLayer& layer, glm::dvec3 p, glm::dvec3 n, bool open_below) {
  double ground = layer.datum, weights = 0;
  each_column(layer, glm::dvec2(p), [&](std::size_t column, double weight) {
    ground += weight * double(layer.ground[column]);
    weights += weight;
  });
  const double level = std::max((p.z - ground) / layer.level_height, 0.0);
  if (weights < 1 - 1e-9 || level >= layer.levels - 1) return 1;
  double v = 0;
  each_column(layer, glm::dvec2(p), [&](std::size_t column, double weight) {
    for (std::uint32_t k = 0; k < layer.levels; ++k)
      v += weight * std::max(0.0, 1 - std::abs(level - k)) * grass_light(layer.light[column * layer.levels + k], n);
  });
  return std::clamp(open_below ? v : v / std::max(open_dome(n.z), 0.01), 0.0, 1.0);
}

}  // namespace understory::reference
