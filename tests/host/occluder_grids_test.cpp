// Scenes whose occluders shade by grids: what is planned and baked, and that pictures hold what they must.
#include "host/frame/occluder_grids.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <set>

#include "tests/support/errors.hpp"
#include "tests/support/fragments.hpp"
#include "tests/support/frames.hpp"
#include "tests/support/temporary_folder.hpp"

namespace understory {
namespace {

/// A folder of its own for the grids that a test bakes.
class OccluderGridsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    UNDERSTORY_NEEDS_DEVICE();
    list_devices();  // settles where kernels are kept before the variable changes
    setenv("XDG_CACHE_HOME", folder_.path().c_str(), 1);
  }
  std::size_t baked(const char* kind) const {
    std::size_t count = 0;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "understory/bakes", none))
      count += entry.path().filename().string().starts_with(kind);
    return count;
  }
  std::size_t grids_baked() const { return baked("grid-"); }
  std::size_t own_shadows_baked() const { return baked("own-shadow-"); }
  TemporaryFolder folder_;
};

Scene cheap(Scene scene, const std::string& method) {
  scene.methods.occluders = method;
  scene.methods.grid.size = 8;
  scene.methods.grid.rays = 32;
  return scene;
}

/// Level ground with a box of 1 m beside the origin.
Scene box_on_ground() {
  Scene scene = open_ground();
  OccluderSource box;
  box.name = "box";
  box.parts.emplace_back();  // a box of 1 m
  box.parts[0].name = "box";
  box.keyframes = {{0, {0.5, 0, 0.5}, {0, 0, 0}}};
  scene.occluders = {box};
  scene.methods.grid.size = 16;
  return scene;
}

TEST_F(OccluderGridsTest, ArePlannedBuiltAndBakedOnlyWhereAsked) {
  Scene scene = cheap(meadow_view(), "grid-cone");
  const World world = build_world(scene);
  const std::size_t parts = scene.occluders[0].parts.size() + scene.occluders[1].parts.size();
  {
    Device device;
    FrameRunner runner(device, world);
    EXPECT_TRUE(runner.plan().has("grid-cone"));
    EXPECT_EQ(grids_baked(), parts);
    EXPECT_EQ(own_shadows_baked(), parts);
    const Frame frame = runner.render(0, 0.5);
    EXPECT_TRUE(frame.terms.contains("grid-cone"));
    EXPECT_TRUE(frame.pass_ms.contains("grid-cone"));
    EXPECT_THAT(device.programs_built(), testing::IsSupersetOf({"grid_cone", "tile_grids"}));
    EXPECT_THAT(device.programs_built(), testing::Not(testing::Contains("grid")));
  }
  for (const char* method : {"solid-angle-cosine", "none"}) {
    const TemporaryFolder fresh;
    setenv("XDG_CACHE_HOME", fresh.path().c_str(), 1);
    scene.methods.occluders = method;
    const World other = build_world(scene);
    Device device;
    FrameRunner runner(device, other);
    EXPECT_THAT(device.programs_built(), testing::Not(testing::Contains(testing::HasSubstr("grid"))));
    EXPECT_FALSE(std::filesystem::exists(fresh / "understory/bakes"));
  }
  scene.methods.occluders = "grid-cone";
  scene.occluders.clear();
  EXPECT_FALSE(make_plan(build_world(scene), scene.methods).has("grid-cone")) << "there is nothing to bake";
}

TEST_F(OccluderGridsTest, PartsThatAreAlikeShareOneGrid) {
  Scene scene = cheap(box_on_ground(), "grid");
  for (int i = 0; i < 9; ++i) {
    OccluderSource other = scene.occluders[0];
    other.name += std::to_string(i);
    other.keyframes[0].position.x += 2 * i;
    scene.occluders.push_back(other);
  }
  const World world = build_world(scene);
  Device device;
  FrameRunner runner(device, world);
  EXPECT_EQ(grids_baked(), 1u);
  EXPECT_EQ(own_shadows_baked(), 0u) << "only grid-cone looks them up";
}

TEST_F(OccluderGridsTest, ABoxShadesTheGroundBesideItAndNotItself) {
  for (const char* method : {"grid", "grid-cone"}) {
    Scene scene = box_on_ground();
    scene.methods.occluders = method;
    const World world = build_world(scene);
    Device device;
    FrameRunner runner(device, world);
    const Frame frame = runner.render(0, 0);
    const Plane& term = frame.terms.at(method);
    float darkest = 1, on_box = 1;
    for (std::size_t i = 0; i < frame.pixels(); ++i) {
      if (is_background(frame, i)) continue;
      const bool box = frame.owners[frame.owner[i]].surface == SurfaceClass::occluder;
      (box ? on_box : darkest) = std::min(box ? on_box : darkest, term[i]);
      const glm::dvec3 p = position_at(frame, i);
      if (std::abs(p.x) > 7 || std::abs(p.y) > 7) {
        EXPECT_EQ(term[i], 1) << "far from the box";
      }
    }
    EXPECT_LT(darkest, 0.8) << method << ": near a wall half of the sky is hidden";
    EXPECT_GE(on_box, method == std::string("grid") ? 0.93f : 1) << method << ": a convex body does not shade itself";
  }
}

TEST_F(OccluderGridsTest, WhatIsInsideASolidIsTold) {
  // The camera is in a box of 1 m and looks at a small one in its middle; behind that, at the wall.
  Scene scene = box_on_ground();
  OccluderSource small = scene.occluders[0];
  small.name = small.parts[0].name = "small";
  small.parts[0].size = glm::dvec3(0.2);
  scene.occluders.push_back(small);
  scene.camera.position = {0.95, 0.1, 0.6};
  scene.camera.target = {0.5, 0, 0.5};
  scene.camera.near_plane = 0.01;
  scene.methods.grid.size = 32;
  for (const char* method : {"grid", "grid-cone"}) {
    scene.methods.occluders = method;
    const World world = build_world(scene);
    Device device;
    FrameRunner runner(device, world);
    const Frame frame = runner.render(0, 0);
    std::size_t on_small = 0, on_wall = 0;
    for (std::size_t i = 0; i < frame.pixels(); ++i) {
      const glm::dvec3 p = glm::abs(position_at(frame, i) - glm::dvec3(0.5, 0, 0.5));
      const bool is_small = std::max({p.x, p.y, p.z}) < 0.11;
      ++(is_small ? on_small : on_wall);
      EXPECT_EQ((frame.validity[i] & validity::occluder_too_close) != 0, is_small) << method << ' ' << i;
      if (is_small) {
        EXPECT_LT(frame.terms.at(method)[i], 0.05f);
      }
    }
    EXPECT_GT(on_small, 50u);
    EXPECT_GT(on_wall, 50u);
  }
}

TEST_F(OccluderGridsTest, BodiesOutOfViewStillShadeWhatIsInView) {
  Scene scene = box_on_ground();
  scene.methods.occluders = "grid-cone";
  // The camera looks at the ground beside the box, which is to the left of the picture.
  scene.camera.position = {-0.45, -0.2, 1};
  scene.camera.target = {-0.45, 0, 0};
  scene.camera.vertical_fov = 0.3;
  const World world = build_world(scene);
  Device device;
  FrameRunner runner(device, world);
  const Frame frame = runner.render(0, 0);
  for (std::size_t i = 0; i < frame.pixels(); ++i) {
    ASSERT_FALSE(is_background(frame, i));
    ASSERT_EQ(frame.owners[frame.owner[i]].surface, SurfaceClass::terrain);
    EXPECT_LT(frame.terms.at("grid-cone")[i], 0.98f);
  }
}

TEST_F(OccluderGridsTest, MovedAndTurnedScenesLookTheSame) {
  Scene scene = box_on_ground();
  scene.methods.occluders = "grid-cone";
  const auto mean_at = [&](glm::dvec3 by) {
    Scene moved = scene;
    moved.camera.position += by;
    moved.camera.target += by;
    moved.terrain.extent.low += glm::dvec2(by);
    moved.terrain.extent.high += glm::dvec2(by);
    moved.occluders[0].keyframes[0].position += by;
    const World world = build_world(moved);
    Device device;
    FrameRunner runner(device, world);
    const Frame frame = runner.render(0, 0);
    double sum = 0;
    for (const float v : frame.terms.at("grid-cone")) sum += double(v);
    return sum / static_cast<double>(frame.pixels());
  };
  EXPECT_NEAR(mean_at(glm::dvec3(0)), mean_at(glm::dvec3(512, -256, 0)), 1e-4);
}

TEST_F(OccluderGridsTest, FramesAreTheSameBytesFreshAndFromTheCache) {
  const Scene scene = cheap(meadow_view(), "grid-cone");
  const World world = build_world(scene);
  Device device;
  const auto frame = [&] { return FrameRunner(device, world).render(0, 0.5); };
  const Frame fresh = frame();
  EXPECT_GT(grids_baked(), 0u);
  EXPECT_THAT(differing_planes(fresh, frame()), testing::IsEmpty());
}

TEST_F(OccluderGridsTest, PlanNamesRulesThatDoNotExist) {
  Scene scene = cheap(meadow_view(), "grid-cone");
  scene.methods.combine = "intersection";
  const World world = build_world(scene);
  EXPECT_THAT(message_of(ErrorKind::invalid_input, [&] { make_plan(world, scene.methods); }),
              testing::AllOf(testing::HasSubstr("methods.combine"), testing::HasSubstr("merge")));
}

}  // namespace
}  // namespace understory
