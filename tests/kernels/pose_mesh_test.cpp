// pose_mesh against the same pose in double with the C++ library's sines, at every vector width; wood keeps its length.
#include <gtest/gtest.h>

#include <cmath>

#include "host/frame/geometry.hpp"
#include "host/passes/pose_mesh.hpp"
#include "sim/pose.hpp"
#include "sim/random.hpp"
#include "sim/rotation.hpp"
#include "tests/reference/pose_mesh.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/meshes.hpp"
#include "tests/support/pose_on_device.hpp"
#include "tests/support/scenes.hpp"

namespace understory {
namespace {

/// Float rounding of two 3x4 products and an arc, for points some 10 m from each other and from the eye.
constexpr double position_error = 1e-5;  // m

struct MeshPose {
  VertexBlocks rest;
  std::vector<PosedBlock> blocks;
  std::vector<LimbPose> limbs;
};

glm::dmat3 random_rotation(Random& random) {
  return glm::mat3_cast(rotation_of(2.0 * glm::dvec3(random.normal(), random.normal(), random.normal())));
}

void store_rows(float (&rows)[12], const glm::dmat3& matrix, glm::dvec3 translation) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) rows[4 * row + column] = static_cast<float>(matrix[column][row]);
    rows[4 * row + 3] = static_cast<float>(translation[row]);
  }
}

LimbPose random_limb(Random& random) {
  LimbPose limb{};
  const auto place = [&](double size) {
    return glm::dvec3(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
  };
  store_rows(limb.to_limb, random_rotation(random), place(1));
  store_rows(limb.to_scene, random.uniform(0.5, 1.5) * random_rotation(random), place(8));
  // Points are within 5.2 m of the limb's base: the arc stays within arc.h's 2.5 rad.
  limb.curvature = random.uniform() < 0.2 ? 0.0f : static_cast<float>(random.uniform(0, 0.45));
  limb.flutter_amplitude = static_cast<float>(random.uniform(0, 0.1 / 127));
  limb.flutter_phase = static_cast<float>(random.uniform(0, 6.283));
  return limb;
}

/// `blocks` posed blocks of 16 that take their rest block and their limb at random.
MeshPose random_pose(std::size_t blocks) {
  Random random(21, 4, blocks);
  MeshPose pose;
  const std::size_t rest_blocks = blocks / 2 + 1;
  for (std::size_t i = 0; i < rest_blocks * vertex_block; ++i) {
    pose.rest.x.push_back(static_cast<float>(random.uniform(-2, 2)));
    pose.rest.y.push_back(static_cast<float>(random.uniform(-2, 2)));
    pose.rest.z.push_back(static_cast<float>(random.uniform(-2, 2)));
    const auto raw = [&] { return static_cast<std::int8_t>(static_cast<int>(random.below(255)) - 127); };
    pose.rest.flutter_x.push_back(raw());
    pose.rest.flutter_y.push_back(raw());
    pose.rest.flutter_z.push_back(raw());
    pose.rest.flutter_phase.push_back(static_cast<std::uint8_t>(random.below(256)));
  }
  for (std::size_t i = 0; i < 11; ++i) pose.limbs.push_back(random_limb(random));
  for (std::size_t i = 0; i < blocks; ++i)
    pose.blocks.push_back({static_cast<record_uint>(random.below(rest_blocks)),
                           static_cast<record_uint>(random.below(pose.limbs.size()))});
  return pose;
}

class PoseMesh : public testing::TestWithParam<int> {
 protected:
  int lanes() const { return GetParam(); }
};
INSTANTIATE_TEST_SUITE_P(Width, PoseMesh, testing::ValuesIn(vector_widths));

TEST_P(PoseMesh, AgreesWithTheReferenceForAnyCount) {
  for (const DeviceInfo& info : list_devices()) {
    Device device(std::to_string(info.index));
    for (std::size_t blocks : {1, 17, 67}) {
      const MeshPose pose = random_pose(blocks);
      const Points posed = pose_mesh_on(device, lanes(), pose.rest, pose.blocks, pose.limbs);
      for (std::size_t i = 0; i < posed.x.size(); ++i) {
        const PosedBlock& block = pose.blocks[i / vertex_block];
        const std::size_t r = block.rest_block * vertex_block + i % vertex_block;
        const VertexBlocks& rest = pose.rest;
        const glm::dvec3 expected =
            reference::posed_point(pose.limbs[block.limb_pose], {rest.x[r], rest.y[r], rest.z[r]},
                                   {rest.flutter_x[r], rest.flutter_y[r], rest.flutter_z[r]}, rest.flutter_phase[r]);
        ASSERT_LT(glm::distance(posed.at(i), expected), position_error) << "vertex " << i << " on " << info.name;
      }
    }
  }
}

TEST_P(PoseMesh, GivesTheBitsOfWidthOne) {
  Device device;
  const MeshPose pose = random_pose(37);
  EXPECT_EQ(pose_mesh_on(device, lanes(), pose.rest, pose.blocks, pose.limbs),
            pose_mesh_on(device, 1, pose.rest, pose.blocks, pose.limbs));
}

TEST_P(PoseMesh, KeepsTheLengthOfABentAxis) {
  // A 5 m axis at 1008 points, bent by up to 2.4 rad: its length is the sum of the arcs over the chords between them.
  constexpr std::size_t blocks = 63;
  constexpr double length = 5;
  VertexBlocks rest;
  std::vector<PosedBlock> in_order;
  for (std::size_t i = 0; i < blocks * vertex_block; ++i)
    rest.x.push_back(static_cast<float>(length * static_cast<double>(i) / (blocks * vertex_block - 1)));
  for (record_uint block = 0; block < blocks; ++block) in_order.push_back({block, 0});
  rest.y = rest.z = std::vector<float>(rest.x.size(), 0);
  rest.flutter_x = rest.flutter_y = rest.flutter_z = std::vector<std::int8_t>(rest.x.size(), 0);
  rest.flutter_phase = std::vector<std::uint8_t>(rest.x.size(), 0);
  Device device;
  for (double angle : {0.0, 0.3, 1.0, 2.4}) {
    LimbPose limb = standing_limb();
    limb.curvature = static_cast<float>(angle / length);
    const Points posed = pose_mesh_on(device, lanes(), rest, in_order, {limb});
    double along = 0;
    for (std::size_t i = 1; i < posed.x.size(); ++i) along += glm::distance(posed.at(i), posed.at(i - 1));
    EXPECT_NEAR(along, length, 2e-5 * length) << angle << " rad";
    const double chord = angle == 0 ? length : 2 * length / angle * std::sin(angle / 2);
    EXPECT_NEAR(glm::distance(posed.at(0), posed.at(posed.x.size() - 1)), chord, 2e-6 * length) << angle << " rad";
  }
}

TEST(PoseMeshPass, PosesEveryInstanceOfAWorldAsTheReferenceDoes) {
  Scene scene = small_meadow();
  scene.grass.clear();
  const World world = build_world(scene);
  Device device;
  Geometry geometry = upload_geometry(device, world);
  for (double time : {0.0, 3.7}) {
    const Pose pose = pose_at(world, time, {-12, -5, 2});
    PoseMeshPass(device).run(geometry.rest, geometry.blocks, upload_test_data(device, pose.limbs), geometry.posed);
    const Points posed = read_points(geometry.posed);
    std::size_t first = 0;
    for (std::size_t i = 0; i < world.instances.size(); ++i) {
      const Prototype& prototype = world.prototypes[world.instances[i].prototype];
      for (std::size_t v = 0; v < prototype.vertices.x.size(); ++v) {
        const glm::dvec3 expected = reference::posed_vertex(prototype, pose, pose.first_limb[i], v);
        // The terrain reaches 140 m from the eye.
        ASSERT_LT(glm::distance(posed.at(first + v), expected), position_error + 3e-7 * glm::length(expected))
            << "instance " << i << " vertex " << v << " at " << time << " s";
      }
      first += prototype.vertices.x.size();
    }
    EXPECT_EQ(first, geometry.mesh_vertices);
  }
}

TEST(PoseMeshPass, RefusesPlanesThatAreTooSmall) {
  Device device;
  const MeshPose pose = random_pose(3);
  const RestVertices rest = upload_rest(device, pose.rest);
  PosedVertices posed{Buffer<std::array<float, 4>>(device, 2 * vertex_block, "posed")};
  const std::string message = message_of(ErrorKind::unexpected, [&] {
    PoseMeshPass(device).run(rest, upload_test_data(device, pose.blocks), upload_test_data(device, pose.limbs), posed);
  });
  EXPECT_NE(message.find("48 vertices"), std::string::npos) << message;
  EXPECT_NE(message.find("32"), std::string::npos) << message;
}

}  // namespace
}  // namespace understory
