// The second place that a scene is judged from: opposite, as far away, and never under the ground.
#include "sim/vantage.hpp"

#include <gmock/gmock.h>

#include "sim/terrain.hpp"
#include "tests/support/scenes.hpp"

namespace understory {
namespace {

World seen_from(glm::dvec3 position, glm::dvec3 target) {
  Scene scene = one_plant(small_species("shrub"));
  scene.camera.position = position;
  scene.camera.target = target;
  return build_world(scene);
}

TEST(Vantage, IsOppositeAsFarAwayAndAsHigh) {
  const std::vector<Camera> cameras = vantage_cameras(seen_from({-3, -20, 2.5}, {1, 0, 1}));
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_EQ(cameras[0].position, glm::dvec3(-3, -20, 2.5));
  EXPECT_EQ(cameras[1].position, glm::dvec3(5, 20, 2.5));
  EXPECT_EQ(cameras[1].target, cameras[0].target);
  EXPECT_EQ(cameras[1].vertical_fov, cameras[0].vertical_fov);
}

TEST(Vantage, KeepsItsHeightAboveAGroundThatRises) {
  World world = seen_from({0, -10, 2}, {0, 0, 1});
  const std::vector<float> heights = {0, 0, 0, 0, 5, 5};  // rises from y = 0 to 20
  world.terrain = std::make_shared<const Terrain>(Terrain::from_grid({{-20, -20}, {20, 20}}, 2, 3, heights));
  EXPECT_NEAR(vantage_cameras(world)[1].position.z, 2.5 + 2, 1e-6);
}

TEST(Vantage, IsAboveTheGroundWhereTheSceneLooksFromBelow) {
  EXPECT_GT(vantage_cameras(seen_from({0, -10, -4}, {0, 0, 1}))[1].position.z, 0);
}

}  // namespace
}  // namespace understory
