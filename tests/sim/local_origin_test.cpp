// A scene in large coordinates is the same scene near its camera: every place in the world stays where it is.
#include "sim/files/local_origin.hpp"

#include <gmock/gmock.h>

#include "sim/files/scene_file.hpp"
#include "tests/support/temporary_file.hpp"

namespace understory {
namespace {

Scene load(const std::string& text) { return load_scene(TemporaryFile("scene.yaml", text).path()); }

TEST(LocalOrigin, MovesTheZeroNearACameraAtUtmCoordinates) {
  const Scene scene = load(R"(
origin: [7, 0, 300]
camera: {position: [500003.5, 5399979.25, 1.7], target: [500000, 5400000, 2]}
terrain: {flat: {extent: {low: [499900, 5399900], high: [500100, 5400100]}}}
species: {elm: {generator: broadleaf}}
plants:
  - {species: elm, spots: [{at: [500001, 5400002]}]}
  - {species: elm, scatter: {region: {low: [499990, 5399990], high: [500010, 5400010]}}}
grass: [{region: {low: [500000, 5400000], high: [500001, 5400002]}}]
occluders:
  - {name: at zero, parts: [{ellipsoid: [1, 1, 1]}]}
  - {name: near, parts: [{ellipsoid: [1, 1, 1]}], keyframes: [{time: 0, position: [500004, 5400005, 6]}]}
)");
  EXPECT_EQ(scene.origin, glm::dvec3(500007, 5400000, 300));
  EXPECT_EQ(scene.camera.position, glm::dvec3(3.5, -20.75, 1.7));
  EXPECT_EQ(scene.camera.target, glm::dvec3(0, 0, 2));
  EXPECT_EQ(scene.terrain.extent.low, glm::dvec2(-100));
  EXPECT_EQ(scene.terrain.extent.high, glm::dvec2(100));
  EXPECT_EQ(scene.plants[0].spots[0].at, glm::dvec2(1, 2));
  EXPECT_EQ(scene.plants[1].region.low, glm::dvec2(-10));
  EXPECT_EQ(scene.grass[0].region.high, glm::dvec2(1, 2));
  EXPECT_EQ(scene.occluders[1].keyframes[0].position, glm::dvec3(4, 5, 6));
}

TEST(LocalOrigin, LeavesBodiesWithoutAPathWhereTheyAre) {
  Scene scene;
  scene.occluders.emplace_back();
  move_zero(scene, {5e5, 5.4e6});
  EXPECT_EQ(scene.origin + scene.occluders[0].keyframes.at(0).position, glm::dvec3(0));
}

TEST(LocalOrigin, LeavesScenesNearTheirZeroAlone) {
  Scene scene;
  scene.camera.position = {-1e4, 1e4, 1e6};
  EXPECT_EQ(local_zero(scene), glm::dvec2(0));
  scene.camera.position.x = -1.0001e4;
  EXPECT_EQ(local_zero(scene), glm::dvec2(-1e4, 1e4));
}

}  // namespace
}  // namespace understory
