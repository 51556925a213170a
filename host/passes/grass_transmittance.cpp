#include "host/passes/grass_transmittance.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/error.hpp"

namespace understory {
namespace {

/// Above, zenith, x and y of every node.
std::vector<float> node_numbers(const GrassLayer& layer) {
  std::vector<float> numbers;
  numbers.reserve(4 * layer.light.size());
  for (const LayerLight& light : layer.light)
    numbers.insert(numbers.end(), {light.above, light.zenith, light.x, light.y});
  return numbers;
}

/// What comes from below of every node, of the one above it, and of these two a row higher: four columns are two loads.
std::vector<float> below_numbers(const GrassLayer& layer, bool open_below) {
  std::vector<float> numbers;
  if (!open_below) return numbers;
  const std::size_t count = layer.light.size(), row = std::size_t{layer.columns} * layer.levels;
  numbers.reserve(4 * count);
  for (std::size_t i = 0; i < count; ++i)
    for (const std::size_t node : {i, i + 1, i + row, i + row + 1})
      numbers.push_back(layer.light[std::min(node, count - 1)].below);
  return numbers;
}

/// The ground of every column and of the one a row higher, so that four columns are one load.
std::vector<float> ground_pairs(const GrassLayer& layer) {
  std::vector<float> pairs;
  const std::size_t count = layer.ground.size();
  pairs.reserve(2 * count);
  for (std::size_t i = 0; i < count; ++i)
    pairs.insert(pairs.end(), {layer.ground[i], layer.ground[std::min(i + layer.columns, count - 1)]});
  return pairs;
}

Buffer<float> upload(Device& device, const std::vector<float>& values, const char* what) {
  return values.empty() ? Buffer<float>() : Buffer<float>(device, std::span<const float>(values), what);
}

}  // namespace

GrassLayerTable::GrassLayerTable(Device& device, const GrassLayer& layer, bool open_below)
    : extent_(layer.extent),
      columns_(layer.columns),
      rows_(layer.rows),
      levels_(layer.levels),
      level_height_(layer.level_height),
      datum_(layer.datum) {
  const std::size_t columns = std::size_t{columns_} * rows_;
  if (columns_ < 2 || rows_ < 2 || levels_ < 2)
    throw Error(ErrorKind::unexpected, "grass-transmittance: a layer of " + std::to_string(columns_) + " x " +
                                           std::to_string(rows_) + " x " + std::to_string(levels_) +
                                           " nodes, at least 2 each way are needed");
  require_size("grass-transmittance", "ground", layer.ground.size(), columns);
  require_size("grass-transmittance", "light", layer.light.size(), columns * levels_);
  ground_ = upload(device, ground_pairs(layer), "ground under grass");
  nodes_ = upload(device, node_numbers(layer), "light among grass");
  below_ = upload(device, below_numbers(layer, open_below), "light from below grass");
}

GrassLayerGrid GrassLayerTable::grid(glm::dvec3 eye) const {
  const glm::dvec2 size = extent_.high - extent_.low;
  GrassLayerGrid grid{};
  grid.low_x = static_cast<float>(extent_.low.x - eye.x);
  grid.low_y = static_cast<float>(extent_.low.y - eye.y);
  grid.columns_per_metre = static_cast<float>(columns_ / size.x);
  grid.rows_per_metre = static_cast<float>(rows_ / size.y);
  grid.columns = columns_;
  grid.rows = rows_;
  grid.levels = levels_;
  grid.levels_per_metre = static_cast<float>(1 / level_height_);
  grid.datum = static_cast<float>(datum_ - eye.z);
  return grid;
}

GrassTransmittancePass::GrassTransmittancePass(Device& device, bool open_below, int lanes)
    : lanes_(device, lanes, "grass-transmittance"),
      open_below_(open_below),
      kernel_(device, "grass_transmittance", "shade_grass_transmittance", "grass-transmittance",
              lanes_.option() + (open_below ? " -DBELOW" : "")) {}

void GrassTransmittancePass::run(const FragmentPlanes& planes, const GrassLayerTable& layer, glm::dvec3 eye,
                                 Buffer<float>& visibility) {
  require_planes("grass-transmittance", planes, visibility);
  if (layer.open_below() != open_below_)
    throw Error(ErrorKind::unexpected, "grass-transmittance: layer and program disagree about the sky below");
  const std::uint32_t groups = GRASS_GROUPS(lanes_.count()), items = lanes_.items(planes) / groups;
  kernel_.launch(items, std::max<std::size_t>(lanes_.local_size() / groups, 1), planes.position_x, planes.position_y,
                 planes.position_z, planes.normal_x, planes.normal_y, planes.normal_z, layer.grid(eye), layer.ground(),
                 layer.nodes(), layer.below(), items, visibility);
}

}  // namespace understory
