#include "host/passes/grass_transmittance.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/error.hpp"

namespace understory {
namespace {

constexpr double steps = 65535;

std::uint16_t number(double value, double low, double high) {
  return static_cast<std::uint16_t>(std::lround(std::clamp((value - low) / (high - low), 0.0, 1.0) * steps));
}

std::vector<std::uint16_t> node_numbers(const GrassLayer& layer) {
  std::vector<std::uint16_t> numbers;
  numbers.reserve(4 * layer.light.size());
  for (const LayerLight& light : layer.light)
    for (const float value : {light.above, light.zenith, light.x, light.y})
      numbers.push_back(number(double(value), layer_low, layer_high));
  return numbers;
}

std::vector<std::uint16_t> below_numbers(const GrassLayer& layer, bool open_below) {
  std::vector<std::uint16_t> numbers;
  for (std::size_t i = 0; open_below && i < layer.light.size(); ++i)
    numbers.push_back(number(double(layer.light[i].below), 0, layer_high));
  return numbers;
}

template <typename T>
Buffer<T> upload(Device& device, const std::vector<T>& values, const char* what) {
  return values.empty() ? Buffer<T>() : Buffer<T>(device, std::span<const T>(values), what);
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
  ground_ = upload(device, layer.ground, "ground under grass");
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
  grid.low = static_cast<float>(layer_low);
  grid.step = static_cast<float>((layer_high - layer_low) / steps);
  grid.below_step = static_cast<float>(layer_high / steps);
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
  const std::uint32_t items = lanes_.items(planes);
  kernel_.launch(items, lanes_.local_size(), planes.position_x, planes.position_y, planes.position_z, planes.normal_x,
                 planes.normal_y, planes.normal_z, layer.grid(eye), layer.ground(), layer.nodes(), layer.below(), items,
                 visibility);
}

}  // namespace understory
