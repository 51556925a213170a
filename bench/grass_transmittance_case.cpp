// grass-transmittance on fragments that all stand among grass, 12 m high, over sloping ground. Light and ground are
// affine in the place, so that interpolation adds no error.
#include <algorithm>
#include <cmath>
#include <memory>

#include "bench/kernel_cases.hpp"
#include "host/passes/grass_transmittance.hpp"

namespace understory {
namespace {

constexpr std::uint32_t side = 256, levels = 13;
constexpr double low_corner = -128;  // m; cells of 1 m

/// Height of the ground, m. Fragments of the bench have x in [-64, 64], y in [-54, 120] and z in [-1, 10].
double ground_at(double x, double y) { return -2 + 0.01 * (x / 128) + 0.005 * (y / 128); }

/// The numbers of a node.
glm::dvec4 light_at(double x, double y, double level) {
  const glm::dvec4 units(42000 + 12 * x - 9 * y + 300 * level, 30000 - 8 * x + 200 * level, 27000 + 10 * y,
                         26000 - 11 * x);
  return units / 65535.0 - 0.4;
}

GrassLayer affine_layer() {
  GrassLayer layer;
  layer.extent = {glm::dvec2(low_corner), glm::dvec2(low_corner + side)};
  layer.columns = layer.rows = side;
  layer.levels = levels;
  layer.level_height = 1;
  for (std::uint32_t row = 0; row < side; ++row)
    for (std::uint32_t column = 0; column < side; ++column) {
      const double x = low_corner + column + 0.5, y = low_corner + row + 0.5;
      layer.ground.push_back(static_cast<float>(ground_at(x, y)));
      for (std::uint32_t level = 0; level < levels; ++level) {
        const glm::dvec4 light = light_at(x, y, level);
        layer.light.push_back({float(light.x), float(light.y), float(light.z), float(light.w), 0});
      }
    }
  return layer;
}

double exact(const BenchFragment& f) {
  const glm::dvec3 p(f.position), n(f.normal);
  const double level = std::max(p.z - ground_at(p.x, p.y), 0.0);
  if (level >= levels - 1) return 1;
  const glm::dvec4 q = light_at(p.x, p.y, level);
  return grass_transmittance({q.x, q.y, q.z, q.w, 0}, n.x, n.y, n.z);
}

}  // namespace

KernelCase grass_transmittance_case() {
  return visibility_case(
      "grass-transmittance",
      3e-5,  // of floats, facing down, where V is over a dome of 0.01
      [](Device& device, BenchFragments& all, Buffer<float>& visibility) {
        const auto layer = std::make_shared<GrassLayerTable>(device, affine_layer(), false);
        return [&, layer, pass = std::make_shared<GrassTransmittancePass>(device, false)] {
          pass->run(all.planes, *layer, glm::dvec3(0), visibility);
        };
      },
      [](const BenchFragments&, const BenchFragment& f) { return exact(f); });
}

}  // namespace understory
