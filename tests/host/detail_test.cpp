// Scene key `detail`: culled frames are the bytes of brute ones, thinned ones keep what is seen of crowns and grass and
// depend on nothing but scene and time.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/frames.hpp"

namespace understory {
namespace {

/// A frame of `world`, whose level of detail it changes.
Frame rendered(World& world, const char* detail, std::uint32_t most_posed_vertices = 1u << 24) {
  world.scene.detail = detail;
  Device device;
  return FrameRunner(device, world, most_posed_vertices).render(0, 0.5);
}

TEST(Detail, CulledFramesAreTheBytesOfBruteOnes) {
  World world = build_world(meadow_view());
  for (const glm::dvec3 target : {glm::dvec3(-7, 2, 1.5), glm::dvec3(-4, -7, 1), glm::dvec3(3, -20, 4)}) {
    world.scene.camera.target = target;
    const Frame brute = rendered(world, "brute");
    EXPECT_EQ(differing_planes(brute, rendered(world, "culled")), std::vector<std::string>())
        << "towards " << target.x << " " << target.y << " " << target.z;
  }
}

TEST(Detail, FramesDrawnInBatchesAreTheSameInAStormByEveryLookUp) {
  Scene scene = meadow_view();
  scene.wind.speed = 20;
  scene.methods.tree = "crown-field";  // reads where a fragment was at rest
  scene.methods.near = "obscurance-line";
  scene.methods.near_field.guard = 7;
  World world = build_world(scene);
  const Frame brute = rendered(world, "brute");
  EXPECT_EQ(differing_planes(brute, rendered(world, "culled")), std::vector<std::string>());
  EXPECT_EQ(differing_planes(brute, rendered(world, "culled", 3000)), std::vector<std::string>());
  EXPECT_EQ(differing_planes(rendered(world, "thinned"), rendered(world, "thinned", 3000)), std::vector<std::string>());
}

TEST(Detail, ThinnedFramesDependOnSceneAndTimeAlone) {
  Scene scene = meadow_view();
  scene.detail = "thinned";
  const World world = build_world(scene);
  Device device;
  FrameRunner runner(device, world);
  const Frame first = runner.render(0, 0.5);
  runner.render(1, 3.5);
  EXPECT_EQ(differing_planes(first, runner.render(0, 0.5)), std::vector<std::string>());
}

TEST(Detail, LeaflessPlantsMayHideOthersAndHaveFarTwigs) {
  Scene scene = meadow_view();
  scene.wind.speed = 20;
  scene.camera.position = scene.camera.target + 4.0 * (scene.camera.position - scene.camera.target);
  World world = build_world(scene);
  for (Prototype& prototype : world.prototypes)
    for (TriangleRun& run : prototype.runs)
      if (run.surface == SurfaceClass::leaf) run.surface = SurfaceClass::wood;
  const Frame brute = rendered(world, "brute"), first = rendered(world, "thinned");
  Device device;
  FrameRunner runner(device, world);
  runner.render(1, 3.5);
  EXPECT_EQ(differing_planes(first, runner.render(0, 0.5)), std::vector<std::string>());
  EXPECT_EQ(differing_planes(first, rendered(world, "thinned", 3000)), std::vector<std::string>());
  std::size_t nearer = 0;  // what was never posed stands at the eye, or where another frame left it
  for (std::size_t i = 0; i < first.pixels(); ++i) nearer += first.depth[i] < 0.8f * brute.depth[i];
  EXPECT_LT(nearer, first.pixels() / 50);
}

TEST(Detail, DumpsHoldWhatIsOutOfView) {
  World world = build_world(meadow_view());
  const auto triangles = [&](const char* detail) {
    world.scene.detail = detail;
    Device device;
    FrameRunner runner(device, world);
    runner.render(0, 0.5);
    return runner.posed_geometry();
  };
  const PosedGeometry brute = triangles("brute"), thinned = triangles("thinned");
  EXPECT_EQ(brute.positions, thinned.positions);
  EXPECT_EQ(brute.triangles, thinned.triangles);
  EXPECT_EQ(brute.owner, thinned.owner);
}

/// Share of the pixels that an owner class covers, and mean V over all of the picture.
struct Look {
  double share[6] = {}, visibility = 0;
};

Look look_of(const Frame& frame) {
  Look look;
  for (std::size_t i = 0; i < frame.pixels(); ++i) {
    look.share[static_cast<std::size_t>(frame.owners[frame.owner[i]].surface)] += 1.0 / double(frame.pixels());
    look.visibility += double(frame.visibility[i]) / double(frame.pixels());
  }
  return look;
}

TEST(Detail, ThinnedCrownsAndGrassCoverAsMuchAsBefore) {
  // From so far away that a leaf is a third of a pixel: most of them go. 400 x 250 samples leave the shares of leaves,
  // sky and grass uncertain by less than a percent.
  Scene scene = meadow_view();
  scene.image = {400, 250};
  scene.camera.position = {-7, -60, 6};
  scene.camera.target = {-7, 2, 2};
  scene.camera.vertical_fov = 0.25;
  World world = build_world(scene);
  const Look brute = look_of(rendered(world, "brute")), thinned = look_of(rendered(world, "thinned"));
  for (std::size_t surface = 0; surface < std::size(brute.share); ++surface)
    EXPECT_NEAR(thinned.share[surface], brute.share[surface], 0.01)
        << surface_class_name(static_cast<SurfaceClass>(surface));
  EXPECT_NEAR(thinned.visibility, brute.visibility, 0.005);
}

}  // namespace
}  // namespace understory
