// grass-transmittance: the device's look-up among grass against double, and what holds at its borders.
#include "host/passes/grass_transmittance.hpp"

#include <gtest/gtest.h>

#include "tests/reference/grass_transmittance.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/fragments.hpp"
#include "tests/support/tolerances.hpp"

namespace understory {
namespace {

const glm::dvec3 eye(5000.25, -3000.5, 80);

/// Nodes of all kinds of light over hilly ground, its border open.
GrassLayer random_layer(std::uint32_t columns, std::uint32_t rows) {
  GrassLayer layer;
  layer.extent = {{eye.x - 3, eye.y - 2}, {eye.x + 4, eye.y + 3}};
  layer.columns = columns;
  layer.rows = rows;
  layer.levels = 5;
  layer.level_height = 0.15;
  layer.datum = eye.z - 2;
  Random random(31, stream_of("layer"));
  for (std::uint32_t i = 0; i < columns * rows; ++i) layer.ground.push_back(float(random.uniform(0, 0.3)));
  for (std::uint32_t i = 0; i < columns * rows * layer.levels; ++i) {
    const double above = random.uniform(0, 0.5), zenith = random.uniform(-0.1, 0.5 - above);
    layer.light.push_back({float(above), float(zenith), float(random.uniform(-0.2, 0.2)),
                           float(random.uniform(-0.2, 0.2)), float(random.uniform(0, 0.4))});
  }
  return layer;
}

std::vector<TestFragment> around(std::size_t count) {
  std::vector<TestFragment> all;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(32, stream_of("around"), i);
    TestFragment f;
    f.position = glm::vec3(random.uniform(-4, 5), random.uniform(-3, 4), random.uniform(-2.3, -0.9));
    f.normal = random_direction(random);
    all.push_back(f);
  }
  return all;
}

Shaded shade(const std::vector<TestFragment>& fragments, const GrassLayer& layer, bool open_below) {
  return shade_everywhere(fragments, [&](Device& device, int lanes, FragmentPlanes& planes, Buffer<float>& visibility) {
    GrassTransmittancePass(device, open_below, lanes)
        .run(planes, GrassLayerTable(device, layer, open_below), eye, visibility);
  });
}

double expected(const GrassLayer& layer, const TestFragment& f, bool open_below) {
  return reference::grass_transmittance(layer, eye + glm::dvec3(f.position), glm::dvec3(f.normal), open_below);
}

/// Within rounding of the grid's border or top, where a place may count to either side.
bool on_border(const GrassLayer& layer, const TestFragment& f) {
  TestFragment moved[6] = {f, f, f, f, f, f};
  for (int k = 0; k < 6; ++k) moved[k].position[k / 2] += k % 2 ? 1e-4f : -1e-4f;
  const double here = expected(layer, f, true);
  return std::any_of(moved, moved + 6,
                     [&](const TestFragment& m) { return std::abs(expected(layer, m, true) - here) > 0.02; });
}

TEST(GrassTransmittance, DeviceIsTheReference) {
  UNDERSTORY_NEEDS_DEVICE();
  for (const bool open_below : {false, true})
    for (const glm::uvec2 grid : {glm::uvec2(14, 9), glm::uvec2(2, 2)}) {
      GrassLayer layer = random_layer(grid.x, grid.y);
      for (LayerLight& light : layer.light) light.below *= open_below ? 1 : 0;
      for (const std::size_t size : odd_sizes) {
        const std::vector<TestFragment> fragments = around(size);
        const Shaded shaded = shade(fragments, layer, open_below);
        for (std::size_t i = 0; i < size; ++i) {
          if (on_border(layer, fragments[i])) continue;
          const double dome = open_below ? 1 : std::max(reference::open_dome(double(fragments[i].normal.z)), 0.01);
          EXPECT_NEAR(shaded.visibility[i], expected(layer, fragments[i], open_below), tolerance::grass_layer / dome)
              << i;
        }
      }
    }
}

TEST(GrassTransmittance, OpenGrassIsOpen) {
  UNDERSTORY_NEEDS_DEVICE();
  GrassLayer layer = random_layer(6, 5);
  for (const bool open_below : {false, true}) {
    std::fill(layer.light.begin(), layer.light.end(), LayerLight{0.5f, 0, 0, 0, open_below ? 0.5f : 0});
    const std::vector<TestFragment> fragments = around(300);
    const Shaded shaded = shade(fragments, layer, open_below);
    for (std::size_t i = 0; i < fragments.size(); ++i)
      if (fragments[i].normal.z > -0.95f) {
        EXPECT_NEAR(shaded.visibility[i], 1, 40 * tolerance::grass_layer);
      }
  }
}

TEST(GrassTransmittance, GarbageStaysWithinBounds) {
  UNDERSTORY_NEEDS_DEVICE();
  GrassLayer layer = random_layer(6, 5);
  layer.ground[3] = NAN;
  layer.ground[4] = INFINITY;
  for (const bool open_below : {false, true}) shade(garbage(3), layer, open_below);  // expects [0, 1]
}

TEST(GrassTransmittance, NamesWhatDoesNotFit) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  GrassLayer layer = random_layer(6, 5);
  EXPECT_NE(message_of(ErrorKind::unexpected, [&] { GrassLayerTable(device, random_layer(1, 5), false); })
                .find("a layer of 1 x 5 x 5 nodes"),
            std::string::npos);
  layer.ground.pop_back();
  EXPECT_NE(message_of(ErrorKind::unexpected, [&] { GrassLayerTable(device, layer, false); }).find("ground has 29"),
            std::string::npos);
}

}  // namespace
}  // namespace understory
