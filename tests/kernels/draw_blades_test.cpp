// draw_blades against blades posed in double precision, widened and as shorter strips of the same area, and against
// rasterise_grass on the vertices that it leaves: every vector width, both layouts of the visibility buffer.
#include <gtest/gtest.h>

#include <cmath>

#include "host/frame/geometry.hpp"
#include "sim/random.hpp"
#include "tests/reference/pose_grass.hpp"
#include "tests/support/drawn_words.hpp"
#include "tests/support/pose_on_device.hpp"

namespace understory {
namespace {

constexpr glm::dvec3 eye(1, -2, 0.5);
constexpr std::uint32_t kinds = 3, first_lane = 48;  // of the 16 blades that are drawn of each group of 256

GrassBlades random_blades(bool upright) {
  Random random(8, 2);
  GrassBlades blades;
  for (std::size_t i = 0; i < kinds * blades_per_group; ++i) {
    const auto add = [&](std::vector<float>& plane, double low, double high) {
      plane.push_back(static_cast<float>(random.uniform(low, high)));
    };
    add(blades.root_x, -1, 3), add(blades.root_y, -3, 3), add(blades.root_z, -0.5, 0);
    add(blades.length, 0.2, 1), add(blades.half_width, 0.002, 0.04);
    add(blades.bend_x, -1, 1), add(blades.bend_y, -1, 1), add(blades.facing, 0, 6.283);
    add(blades.flexibility, 0.5, 2), add(blades.phase, 0, 6.283);
    if (upright || i % 2 == 0) blades.bend_x.back() = blades.bend_y.back() = 0;
  }
  return blades;
}

GrassWind calm() {
  GrassWind wind{};
  wind.direction_x = wind.lateral_scale = wind.series_rate = 1;
  wind.series_count = 2;
  wind.root_offset_x = static_cast<float>(-eye.x);
  wind.root_offset_y = static_cast<float>(-eye.y);
  wind.root_offset_z = static_cast<float>(-eye.z);
  return wind;
}

/// A group of blades per kind of strip: of `pairs` pairs and a tip, 1 + pairs times as wide as at rest.
struct Strips {
  explicit Strips(Device& device, bool upright = false) {
    std::vector<FieldRange> ranges;
    upload_blades(device, {random_blades(upright)}, 0, rest, ranges);
    units.push_back({});  // of another field
    for (std::uint32_t pairs = 1; pairs <= kinds; ++pairs) {
      const std::uint32_t first_vertex = (pairs - 1) * vertices_per_blade * blades_per_group;
      units.push_back({static_cast<std::uint32_t>(chunks.size()) * triangles_per_chunk + first_lane,
                       1.0f + static_cast<float>(pairs), pairs, 0});
      for (std::uint32_t k = 0; k < 2 * pairs - 1; ++k)
        chunks.push_back({first_vertex + k * blades_per_group, (pairs - 1) * blades_per_group, blades_per_group, 1});
    }
    posed.points = upload_test_data(
        device, std::vector(std::size_t{kinds} * vertices_per_blade * blades_per_group, untouched_point));
  }
  RestBlades rest;
  std::vector<TriangleChunk> chunks;
  std::vector<BladeUnit> units;
  PosedVertices posed;
};

std::vector<std::uint32_t> draw(Device& device, Strips& strips, int lanes, bool wide_atomics) {
  const auto series = upload_test_data(device, std::vector<std::array<float, 2>>(2));
  const auto units = upload_test_data(device, strips.units);
  const auto chunks = upload_test_data(device, strips.chunks);
  const RestBlades& rest = strips.rest;
  return drawn_words(device, "draw_blades", "draw_blades", lanes, wide_atomics, [&](Kernel& kernel, auto& words) {
    const auto items = static_cast<std::uint32_t>(kinds * 16 / static_cast<std::uint32_t>(lanes));
    kernel.launch(items, 64, rest.root_x, rest.root_y, rest.root_z, rest.length, rest.half_width, rest.bend_x,
                  rest.bend_y, rest.facing_x, rest.facing_y, rest.flexibility, rest.phase, calm(), series, units, 1u,
                  items, chunks, small_level_view(), strips.posed.points, words);
  });
}

double area(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) { return 0.5 * glm::length(glm::cross(b - a, c - a)); }

double mean_height(const std::vector<glm::dvec3>& strip) {
  double moment = 0, whole = 0;
  for (std::size_t k = 0; k + 2 < strip.size(); ++k) {
    const double part = area(strip[k], strip[k + 1], strip[k + 2]);
    whole += part;
    moment += part * (strip[k].z + strip[k + 1].z + strip[k + 2].z) / 3;
  }
  return moment / whole;
}

std::vector<glm::dvec3> strip_of(const Points& posed, std::uint32_t pairs, std::size_t lane) {
  std::vector<glm::dvec3> strip;
  for (std::size_t k = 0; k <= 2 * pairs; ++k)
    strip.push_back(posed.at(((pairs - 1) * vertices_per_blade + k) * blades_per_group + lane));
  return strip;
}

TEST(DrawBlades, WidensBladesThatKeepTheirAreaAsShorterStrips) {
  Device device;
  const GrassBlades blades = random_blades(false);
  Strips strips(device);
  draw(device, strips, 1, false);
  const Points posed = read_points(strips.posed);
  for (std::uint32_t pairs = 1; pairs <= kinds; ++pairs) {
    for (std::size_t lane = first_lane; lane < first_lane + 16; ++lane) {
      const std::size_t i = (pairs - 1) * blades_per_group + lane;
      const std::vector<glm::dvec3> strip = strip_of(posed, pairs, lane);
      const glm::dvec3 root = glm::dvec3(blades.root_x[i], blades.root_y[i], blades.root_z[i]) - eye;
      const glm::dvec2 bend(blades.bend_x[i], blades.bend_y[i]);
      const double length = double(blades.length[i]);
      const auto whole = reference::posed_blade(root, length, double(blades.half_width[i]) * (1 + pairs),
                                                double(blades.facing[i]), bend);
      const bool upside_down = pairs == 1 && lane % 16 % 5 == 2;
      EXPECT_LT(glm::distance(strip.back(), upside_down ? root : whole[6]), 2e-5) << "tip";
      EXPECT_LT(glm::distance(0.5 * (strip[0] + strip[1]), upside_down ? whole[6] : root), 2e-5) << "root";
      if (pairs == 2) {
        const glm::dvec3 middle = root + reference::blade_midline(length, bend, 0.6);
        EXPECT_LT(glm::distance(0.5 * (strip[2] + strip[3]), middle), 2e-5);
      }
      for (std::size_t k = 0; pairs == 3 && k < 7; ++k) EXPECT_LT(glm::distance(strip[k], whole[k]), 2e-5);
      if (i % 2 == 1) continue;  // upright blades are flat
      double drawn = 0, expected = 0;
      for (std::size_t k = 0; k < 2 * pairs - 1; ++k) drawn += area(strip[k], strip[k + 1], strip[k + 2]);
      for (std::size_t k = 0; k < 5; ++k) expected += area(whole[k], whole[k + 1], whole[k + 2]);
      EXPECT_NEAR(drawn, expected, 1e-3 * expected) << pairs << " pairs";
    }
    if (pairs < 3) {
      EXPECT_EQ(posed.x[((pairs - 1) * vertices_per_blade + 2 * pairs + 1) * blades_per_group + first_lane], untouched);
    }
  }
}

TEST(DrawBlades, ShorterStripsStandAsHighOnTheMean) {
  Device device;
  const GrassBlades blades = random_blades(true);
  Strips strips(device, true);
  draw(device, strips, 1, false);
  const Points posed = read_points(strips.posed);
  double mean[kinds];  // in lengths
  for (std::uint32_t pairs = 1; pairs <= kinds; ++pairs) {
    mean[pairs - 1] = 0;
    for (std::size_t lane = first_lane; lane < first_lane + 16; ++lane) {
      const std::size_t i = (pairs - 1) * blades_per_group + lane;
      const double height = mean_height(strip_of(posed, pairs, lane)) - (double(blades.root_z[i]) - eye.z);
      mean[pairs - 1] += height / double(blades.length[i]) / 16;
    }
  }
  EXPECT_NEAR(mean[2], 0.3833, 1e-3);
  EXPECT_NEAR(mean[1], mean[2], 1e-3);
  EXPECT_NEAR(mean[0], mean[2], 0.02);  // 3 of 16 upside down
}

TEST(DrawBlades, SeesWhatRasteriseGrassSeesAtEveryWidthInBothLayouts) {
  for (const DeviceInfo& info : list_devices()) {
    Device device(std::to_string(info.index));
    Strips first(device);
    draw(device, first, 1, false);
    const Points posed = read_points(first.posed);
    for (const bool wide : {false, true}) {
      if (wide && !info.atomic64) continue;
      const auto expected =
          drawn_words(device, "rasterise", "rasterise_grass", 1, wide, [&](Kernel& kernel, auto& words) {
            kernel.launch(first.chunks.size() * triangles_per_chunk, triangles_per_chunk,
                          upload_test_data(device, first.chunks), 0u, first.posed.points, small_level_view(), words);
          });
      EXPECT_GT(drawn_pixels(expected, wide), 60u);
      for (const int lanes : vector_widths) {
        Strips strips(device);
        EXPECT_EQ(draw(device, strips, lanes, wide), expected) << "W = " << lanes << " on " << info.name;
        EXPECT_EQ(read_points(strips.posed), posed) << "W = " << lanes << " on " << info.name;
      }
    }
  }
}

}  // namespace
}  // namespace understory
