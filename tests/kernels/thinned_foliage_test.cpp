// pose_mesh and pose_grass with -DTHINNED against the double-precision references: leaves enlarged about their middles,
// blades widened and as shorter strips of the same area.
#include <gtest/gtest.h>

#include <cmath>

#include "host/frame/geometry.hpp"
#include "sim/grass_wind.hpp"
#include "sim/random.hpp"
#include "tests/reference/pose_grass.hpp"
#include "tests/reference/pose_mesh.hpp"
#include "tests/support/meshes.hpp"
#include "tests/support/pose_on_device.hpp"

namespace understory {
namespace {

constexpr std::size_t blocks = 37;

struct Leaves {
  VertexBlocks rest;
  std::array<std::vector<float>, 3> pivot;
  std::vector<float> scale;
  std::vector<PosedBlock> posed;
  LimbPose limb = standing_limb();
};

Leaves random_leaves() {
  Random random(5, 9);
  Leaves leaves;
  leaves.limb.curvature = 0.2f;
  leaves.limb.flutter_amplitude = 0.001f;
  leaves.limb.flutter_phase = 1.1f;
  for (record_uint block = 0; block < blocks; ++block) {
    leaves.posed.push_back({static_cast<record_uint>(blocks) - 1 - block, 0});
    leaves.scale.push_back(static_cast<float>(random.uniform(0, 3)));
  }
  for (std::size_t i = 0; i < blocks * vertex_block; ++i) {
    for (std::vector<float>* plane :
         {&leaves.rest.x, &leaves.rest.y, &leaves.rest.z, &leaves.pivot[0], &leaves.pivot[1], &leaves.pivot[2]})
      plane->push_back(static_cast<float>(random.uniform(-2, 2)));
    for (std::vector<std::int8_t>* plane : {&leaves.rest.flutter_x, &leaves.rest.flutter_y, &leaves.rest.flutter_z})
      plane->push_back(static_cast<std::int8_t>(random.uniform(-127, 127)));
    leaves.rest.flutter_phase.push_back(static_cast<std::uint8_t>(random.below(256)));
  }
  return leaves;
}

Points posed_leaves(Device& device, const Leaves& leaves, int lanes) {
  Kernel kernel(device, "pose_mesh", "pose_mesh", "pose_mesh", "-DTHINNED -DW=" + std::to_string(lanes));
  const RestVertices rest = upload_rest(device, leaves.rest);
  PosedVertices posed{Buffer<std::array<float, 4>>(device, blocks * vertex_block, "posed")};
  const auto items = static_cast<std::uint32_t>(blocks * vertex_block / static_cast<std::size_t>(lanes));
  kernel.launch(items, 64, rest.x, rest.y, rest.z, rest.flutter_x, rest.flutter_y, rest.flutter_z, rest.flutter_phase,
                upload_test_data(device, leaves.posed), upload_test_data(device, std::vector{leaves.limb}),
                posed.points, items, upload_test_data(device, leaves.pivot[0]),
                upload_test_data(device, leaves.pivot[1]), upload_test_data(device, leaves.pivot[2]),
                upload_test_data(device, leaves.scale));
  return read_points(posed);
}

TEST(ThinnedFoliage, LeavesAreEnlargedAboutTheirMiddles) {
  Device device;
  const Leaves leaves = random_leaves();
  const Points posed = posed_leaves(device, leaves, 1);
  for (std::size_t i = 0; i < posed.x.size(); ++i) {
    const std::size_t block = i / vertex_block, v = leaves.posed[block].rest_block * vertex_block + i % vertex_block;
    const glm::dvec3 middle(leaves.pivot[0][v], leaves.pivot[1][v], leaves.pivot[2][v]);
    const glm::dvec3 rest(leaves.rest.x[v], leaves.rest.y[v], leaves.rest.z[v]);
    const glm::dvec3 flutter(leaves.rest.flutter_x[v], leaves.rest.flutter_y[v], leaves.rest.flutter_z[v]);
    const glm::dvec3 expected = reference::posed_point(
        leaves.limb, middle + double(leaves.scale[block]) * (rest - middle), flutter, leaves.rest.flutter_phase[v]);
    ASSERT_LT(glm::distance(posed.at(i), expected), 2e-5) << i;
  }
  for (const int lanes : vector_widths) EXPECT_EQ(posed_leaves(device, leaves, lanes), posed) << "W = " << lanes;
}

constexpr glm::dvec3 eye(1, -2, 1.5);

GrassBlades random_blades(std::size_t count) {
  Random random(8, 2);
  GrassBlades blades;
  for (std::size_t i = 0; i < count; ++i) {
    const auto add = [&](std::vector<float>& plane, double low, double high) {
      plane.push_back(static_cast<float>(random.uniform(low, high)));
    };
    add(blades.root_x, -9, 9), add(blades.root_y, -9, 9), add(blades.root_z, -1, 1);
    add(blades.length, 0.2, 1), add(blades.half_width, 0.002, 0.02);
    add(blades.bend_x, -1, 1), add(blades.bend_y, -1, 1), add(blades.facing, 0, 6.283);
    add(blades.flexibility, 0.5, 2), add(blades.phase, 0, 6.283);
  }
  return blades;
}

/// Three units of 16 blades, one per kind of strip, each in 7 x 256 vertices of its own.
Points posed_blades(Device& device, const GrassBlades& blades, const GrassWind& wind, int lanes) {
  RestBlades rest;
  std::vector<FieldRange> ranges;
  upload_blades(device, {blades}, 0, rest, ranges);
  std::vector<BladeUnit> units;
  for (std::uint32_t pairs = 1; pairs <= 3; ++pairs)
    units.push_back({(pairs - 1) * 32, (pairs - 1) * 7 * 256 + 48, 1.0f + static_cast<float>(pairs), pairs});
  units.insert(units.begin(), BladeUnit{});  // of another field
  Kernel kernel(device, "pose_grass", "pose_grass", "pose_grass", "-DTHINNED -DW=" + std::to_string(lanes));
  PosedVertices posed{upload_test_data(device, std::vector(3 * 7 * 256, untouched_point))};
  const auto items = static_cast<std::uint32_t>(3 * 16 / lanes);
  kernel.launch(items, 64, rest.root_x, rest.root_y, rest.root_z, rest.length, rest.half_width, rest.bend_x,
                rest.bend_y, rest.facing_x, rest.facing_y, rest.flexibility, rest.phase, wind,
                upload_test_data(device, std::vector<std::array<float, 2>>(2)), upload_test_data(device, units), 1u,
                items, posed.points);
  return read_points(posed);
}

double area(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) { return 0.5 * glm::length(glm::cross(b - a, c - a)); }

TEST(ThinnedFoliage, BladesAreWidenedAndKeepTheirAreaAsShorterStrips) {
  Device device;
  GrassBlades blades = random_blades(96);
  for (std::size_t i = 0; i < blades.size(); i += 2) blades.bend_x[i] = blades.bend_y[i] = 0;
  GrassWind wind{};
  wind.direction_x = wind.lateral_scale = wind.series_rate = 1;
  wind.series_count = 2;
  wind.root_offset_x = static_cast<float>(-eye.x);
  wind.root_offset_y = static_cast<float>(-eye.y);
  wind.root_offset_z = static_cast<float>(-eye.z);
  const Points posed = posed_blades(device, blades, wind, 1);
  for (std::uint32_t pairs = 1; pairs <= 3; ++pairs)
    for (std::size_t lane = 0; lane < 16; ++lane) {
      const std::size_t i = (pairs - 1) * 32 + lane, first = (pairs - 1) * 7 * 256 + 48 + lane;
      const auto vertex = [&](std::size_t k) { return posed.at(first + 256 * k); };
      const glm::dvec3 root = glm::dvec3(blades.root_x[i], blades.root_y[i], blades.root_z[i]) - eye;
      const glm::dvec2 bend(blades.bend_x[i], blades.bend_y[i]);
      const auto whole = reference::posed_blade(
          root, double(blades.length[i]), double(blades.half_width[i]) * (1 + pairs), double(blades.facing[i]), bend);
      EXPECT_LT(glm::distance(vertex(2 * pairs), whole[6]), 2e-5) << "tip";
      EXPECT_LT(glm::distance(0.5 * (vertex(0) + vertex(1)), root), 2e-5) << "root";
      if (pairs == 2) {
        const glm::dvec3 middle = root + reference::blade_midline(double(blades.length[i]), bend, 0.6);
        EXPECT_LT(glm::distance(0.5 * (vertex(2) + vertex(3)), middle), 2e-5);
      }
      for (std::size_t k = 0; pairs == 3 && k < 7; ++k) EXPECT_LT(glm::distance(vertex(k), whole[k]), 2e-5);
      if (i % 2 == 1) continue;  // upright blades are flat
      double drawn = 0, expected = 0;
      for (std::size_t k = 0; k < 2 * pairs - 1; ++k) drawn += area(vertex(k), vertex(k + 1), vertex(k + 2));
      for (std::size_t k = 0; k < 5; ++k) expected += area(whole[k], whole[k + 1], whole[k + 2]);
      EXPECT_NEAR(drawn, expected, 1e-3 * expected) << pairs << " pairs";
      if (pairs < 3) {
        EXPECT_EQ(vertex(2 * pairs + 1).x, double(untouched)) << "writes no more";
      }
    }
  for (const int lanes : vector_widths) EXPECT_EQ(posed_blades(device, blades, wind, lanes), posed) << "W = " << lanes;
}

}  // namespace
}  // namespace understory
