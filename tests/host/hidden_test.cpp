// Occlusion culling within a frame: what is called hidden is behind the drawn depth at every point, what stands plainly
// behind a wall is found hidden, and frames keep their bytes.
#include "host/frame/hidden.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "host/frame/camera_view.hpp"
#include "sim/random.hpp"
#include "tests/reference/farthest_depth.hpp"
#include "tests/support/frames.hpp"
#include "tests/support/temporary_folder.hpp"

namespace understory {
namespace {

constexpr int width = 123, height = 77, tile = 8;

CameraView slanting_view() {
  Camera camera;
  camera.position = {0, 0, 0};
  camera.target = {1, 3, -0.4};
  camera.near_plane = 0.1;
  return camera_view(camera, {width, height}, glm::dvec2(0.3, -0.2));
}

double along(const float (&axis)[4], const glm::dvec3& p) {
  return double(axis[0]) * p.x + double(axis[1]) * p.y + double(axis[2]) * p.z;
}

/// The point at camera coordinates (right, down, ahead).
glm::dvec3 point_at(const CameraView& view, glm::dvec3 p) {
  const auto axis = [](const float(&a)[4]) { return glm::dvec3(a[0], a[1], a[2]); };
  return p.x * axis(view.right) + p.y * axis(view.down) + p.z * axis(view.forward);
}

/// Rough ground that rises to the top, with holes where nothing is drawn.
std::vector<float> rough_depths() {
  Random random(8, 1);
  std::vector<float> depth;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      depth.push_back(random.uniform() < 0.002 ? INFINITY
                                               : static_cast<float>(2 + 0.1 * (height - y) + 0.3 * random.uniform()));
  return depth;
}

TEST(Hidden, NothingThatReachesInFrontOfTheDrawnDepth) {
  const std::vector<float> depth = rough_depths();
  const CameraView view = slanting_view();
  const DrawnDepth drawn{view, reference::farthest_depth(depth, width, tile)};
  ASSERT_TRUE(drawn.hides());
  Random random(5, 3);
  int hidden = 0;
  for (int i = 0; i < 20000; ++i) {
    const double ahead = random.uniform(-2, 30), radius = std::exp2(random.uniform(-6, 2));
    const glm::dvec3 centre = point_at(view, {random.uniform(-1, 1) * ahead, random.uniform(-1, 1) * ahead, ahead});
    if (!is_hidden(drawn, centre, radius)) continue;
    ++hidden;
    for (int k = 0; k < 60; ++k) {  // points on and within the sphere
      const glm::dvec3 way(random.normal(), random.normal(), random.normal());
      const glm::dvec3 p = centre + radius * (k % 2 ? 1.0 : random.uniform()) * glm::normalize(way);
      const double z = along(view.forward, p);
      const double x = along(view.right, p) * double(view.focal) / z + double(view.centre_x);
      const double y = along(view.down, p) * double(view.focal) / z + double(view.centre_y);
      if (z <= 0 || x < 0 || y < 0 || x >= width || y >= height) continue;
      const auto pixel = static_cast<std::size_t>(static_cast<int>(y) * width + static_cast<int>(x));
      ASSERT_GT(z, double(depth[pixel])) << "sphere " << i << " at pixel " << x << " " << y;
    }
  }
  EXPECT_GT(hidden, 1000) << "what is behind is found to be";
}

TEST(Hidden, WhatIsPlainlyBehindAWallAndNothingBeforeIt) {
  const CameraView view = slanting_view();
  const DrawnDepth wall{view, reference::farthest_depth(std::vector<float>(width * height, 5.0f), width, tile)};
  EXPECT_TRUE(is_hidden(wall, point_at(view, {0, 0, 7}), 1.9));
  EXPECT_FALSE(is_hidden(wall, point_at(view, {0, 0, 7}), 2.1)) << "it reaches through";
  EXPECT_FALSE(is_hidden(wall, point_at(view, {0, 0, 3}), 0.5));
  EXPECT_FALSE(is_hidden(wall, point_at(view, {0, 0, -9}), 1)) << "behind the eye no depth says anything";
  EXPECT_FALSE(is_hidden(wall, point_at(view, {0, 0, NAN}), 1));
  EXPECT_FALSE(is_hidden(DrawnDepth{}, point_at(view, {0, 0, 7}), 1)) << "nothing is drawn";
}

/// The small meadow behind a house.
Scene behind_a_house() {
  Scene scene = meadow_view();
  OccluderSource house;
  house.name = "house";
  house.parts.push_back({"walls", OccluderPart::Shape::box, {5, 1, 6}, {}, {}, UpAxis::y, 1, {}, {}});
  house.keyframes = {{0, {-7, -2, 3}, {0, 0, 0.2}}};
  scene.occluders.push_back(house);
  return scene;
}

/// The small meadow on the far side of a ridge.
Scene behind_a_ridge(const std::filesystem::path& folder) {
  std::ofstream file(folder / "ridge.obj");
  constexpr int cells = 60;
  const auto at = [](int k) { return -30.0 + k; };
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i)
      file << "v " << at(i) << ' ' << at(j) << ' ' << 2.5 * std::exp(-0.1 * (at(j) + 3) * (at(j) + 3)) << '\n';
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const int v = 1 + j * (cells + 1) + i;
      file << "f " << v << ' ' << v + 1 << ' ' << v + cells + 2 << ' ' << v + cells + 1 << '\n';
    }
  Scene scene = meadow_view();
  scene.terrain.kind = TerrainSource::Kind::mesh;
  scene.terrain.file = folder / "ridge.obj";
  scene.camera.target = {-7, 2, 1.2};
  return scene;
}

struct Drawn {
  Frame frame;
  std::uint64_t triangles;
};

Drawn rendered(World& world, const char* detail, std::uint32_t most_posed_vertices = 1u << 24) {
  world.scene.detail = detail;
  Device device;
  FrameRunner runner(device, world, most_posed_vertices);
  runner.render(1, 2.5);  // another frame first: its lists have other lengths
  Drawn drawn{runner.render(0, 0.5), 0};
  drawn.triangles = runner.drawn_triangles();
  return drawn;
}

TEST(Hidden, FramesBehindHouseAndRidgeKeepTheirBytes) {
  const TemporaryFolder folder;
  World open = build_world(meadow_view());
  const std::uint64_t in_view = rendered(open, "culled").triangles;
  for (const Scene& scene : {behind_a_house(), behind_a_ridge(folder.path())}) {
    World world = build_world(scene);
    const Drawn brute = rendered(world, "brute"), culled = rendered(world, "culled");
    EXPECT_EQ(differing_planes(brute.frame, culled.frame), std::vector<std::string>());
    EXPECT_EQ(differing_planes(brute.frame, rendered(world, "culled", 3000).frame), std::vector<std::string>());
    EXPECT_EQ(differing_planes(rendered(world, "thinned").frame, rendered(world, "thinned", 3000).frame),
              std::vector<std::string>());
    EXPECT_LT(culled.triangles, in_view * 9 / 10) << "what is behind is not drawn";
  }
}

}  // namespace
}  // namespace understory
