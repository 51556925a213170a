// draw_far against pieces posed in double precision, enlarged about their middles, and against rasterise_mesh on the
// vertices that it leaves: every vector width, both layouts of the visibility buffer.
#include <gtest/gtest.h>

#include "sim/prototype.hpp"
#include "sim/random.hpp"
#include "tests/reference/pose_mesh.hpp"
#include "tests/support/drawn_words.hpp"
#include "tests/support/meshes.hpp"
#include "tests/support/pose_on_device.hpp"

namespace understory {
namespace {

constexpr std::uint32_t units = 21, rest_units = 30;  // of 16 pieces, in blocks of their own; more are at rest
constexpr std::uint32_t first_block = 2;              // blocks of other meshes come before

struct FarPieces {
  explicit FarPieces(Device& device);
  VertexBlocks rest;
  std::vector<PosedBlock> blocks;
  std::vector<float> scale;
  std::vector<FarUnit> units_drawn;
  std::vector<TriangleChunk> chunks;
  std::array<std::vector<std::uint32_t>, 3> index;
  LimbPose limb = standing_limb();
  PosedVertices posed;
};

FarPieces::FarPieces(Device& device) {
  Random random(5, 9);
  const auto between = [&](double low, double high) { return static_cast<float>(random.uniform(low, high)); };
  limb.curvature = 0.05f;
  limb.flutter_amplitude = 0.0002f;
  limb.flutter_phase = 1.1f;
  for (std::uint32_t unit = 0; unit < rest_units; ++unit) {
    std::vector<glm::vec3> middles;
    for (int l = 0; l < 16; ++l) middles.emplace_back(between(-3, 3), between(-1, 8), between(-2, 2));
    for (std::size_t i = 0; i < 48; ++i) {
      const glm::vec3& middle = middles[i % 16];
      rest.x.push_back(middle.x + between(-0.3, 0.3));
      rest.y.push_back(middle.y + between(-0.3, 0.3));
      rest.z.push_back(middle.z + between(-0.3, 0.3));
      for (std::vector<std::int8_t>* plane : {&rest.flutter_x, &rest.flutter_y, &rest.flutter_z})
        plane->push_back(static_cast<std::int8_t>(random.uniform(-127, 127)));
      rest.flutter_phase.push_back(static_cast<std::uint8_t>(random.below(256)));
    }
  }
  blocks.assign(first_block, {0, 0});
  scale.assign(first_block, 1);
  for (std::uint32_t unit = 0; unit < units; ++unit) {
    units_drawn.push_back({first_block + 3 * unit, unit * 16});
    const float factor = unit % 3 == 0 ? 1.0f : between(0.5, 1.5);
    for (std::uint32_t k = 0; k < 3; ++k) {
      blocks.push_back({(rest_units - 1 - unit) * 3 + k, 0});
      scale.push_back(factor);
    }
    for (std::uint32_t l = 0; l < 16; ++l)
      for (std::uint32_t k = 0; k < 3; ++k) index[k].push_back(unit * 48 + 16 * k + l);
  }
  for (std::uint32_t done = 0; done < 16 * units; done += triangles_per_chunk)
    chunks.push_back({first_block * 16, done, std::min(triangles_per_chunk, 16 * units - done), 1});
  posed.points = upload_test_data(device, std::vector(blocks.size() * vertex_block, untouched_point));
}

std::vector<std::uint32_t> draw(Device& device, FarPieces& far, int lanes, bool wide_atomics) {
  const RestVertices rest = upload_rest(device, far.rest);
  const auto blocks = upload_test_data(device, far.blocks);
  const auto scale = upload_test_data(device, far.scale);
  const auto limbs = upload_test_data(device, std::vector{far.limb});
  const auto listed = upload_test_data(device, far.units_drawn);
  return drawn_words(device, "draw_far", "draw_far", lanes, wide_atomics, [&](Kernel& kernel, auto& words) {
    const auto items = static_cast<std::uint32_t>(units * 16 / static_cast<std::uint32_t>(lanes));
    kernel.launch(items, 64, rest.x, rest.y, rest.z, rest.flutter_x, rest.flutter_y, rest.flutter_z, rest.flutter_phase,
                  blocks, scale, limbs, listed, items, small_level_view(), far.posed.points, words);
  });
}

TEST(DrawFar, PosesPiecesEnlargedAboutTheirMiddles) {
  Device device;
  FarPieces far(device);
  draw(device, far, 1, false);
  const Points posed = read_points(far.posed);
  for (std::size_t i = 0; i < first_block * vertex_block; ++i) ASSERT_EQ(posed.x[i], untouched);
  for (std::size_t unit = 0; unit < units; ++unit)
    for (std::size_t l = 0; l < 16; ++l)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t block = first_block + 3 * unit;
        const auto rest_index = [&](std::size_t corner) {
          return (far.blocks[block].rest_block + corner) * vertex_block + l;
        };
        const auto rest = [&](std::size_t corner) {
          const std::size_t v = rest_index(corner);
          return glm::dvec3(far.rest.x[v], far.rest.y[v], far.rest.z[v]);
        };
        const glm::dvec3 middle = (rest(0) + rest(1) + rest(2)) / 3.0;
        const std::size_t v = rest_index(k);
        const glm::dvec3 flutter(far.rest.flutter_x[v], far.rest.flutter_y[v], far.rest.flutter_z[v]);
        const glm::dvec3 expected = reference::posed_point(
            far.limb, middle + double(far.scale[block]) * (rest(k) - middle), flutter, far.rest.flutter_phase[v]);
        ASSERT_LT(glm::distance(posed.at(block * vertex_block + 16 * k + l), expected), 2e-5) << unit << " " << l;
      }
}

TEST(DrawFar, SeesWhatRasteriseMeshSeesAtEveryWidthInBothLayouts) {
  for (const DeviceInfo& info : list_devices()) {
    Device device(std::to_string(info.index));
    FarPieces first(device);
    draw(device, first, 1, false);
    const Points posed = read_points(first.posed);
    for (const bool wide : {false, true}) {
      if (wide && !info.atomic64) continue;
      const auto expected =
          drawn_words(device, "rasterise", "rasterise_mesh", 1, wide, [&](Kernel& kernel, auto& words) {
            kernel.launch(first.chunks.size() * triangles_per_chunk, triangles_per_chunk,
                          upload_test_data(device, first.chunks), upload_test_data(device, first.index[0]),
                          upload_test_data(device, first.index[1]), upload_test_data(device, first.index[2]),
                          first.posed.points, small_level_view(), words);
          });
      EXPECT_GT(drawn_pixels(expected, wide), 100u);
      for (const int lanes : vector_widths) {
        FarPieces far(device);
        EXPECT_EQ(draw(device, far, lanes, wide), expected) << "W = " << lanes << " on " << info.name;
        EXPECT_EQ(read_points(far.posed), posed) << "W = " << lanes << " on " << info.name;
      }
    }
  }
}

}  // namespace
}  // namespace understory
