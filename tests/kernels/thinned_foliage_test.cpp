// pose_mesh with -DTHINNED against the double-precision reference: leaves enlarged about their middles.
#include <gtest/gtest.h>

#include "sim/random.hpp"
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

}  // namespace
}  // namespace understory
