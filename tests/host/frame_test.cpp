// A frame is a function of (scene, methods, time): not of what ran before, of who runs it, or of where the scene lies.
#include <gmock/gmock.h>

#include <cmath>

#include "tests/support/frames.hpp"

namespace understory {
namespace {

using testing::IsEmpty;

const World& meadow() {
  static const World world = build_world(meadow_view());
  return world;
}

Frame render_alone(const World& world, double time) {
  Device device;
  return FrameRunner(device, world).render(0, time);
}

TEST(Frame, IsTheSameTwiceAloneAndAfterAnyOthers) {
  Device device;
  FrameRunner runner(device, meadow());
  const double times[] = {0, 0.25, 7.5};
  std::vector<Frame> first;
  for (double time : times) first.push_back(runner.render(0, time));
  EXPECT_THAT(differing_planes(first[0], first[1]), testing::Not(IsEmpty())) << "nothing moves";
  for (std::size_t i : {2u, 0u, 0u, 1u}) {
    const Frame again = runner.render(static_cast<int>(i), times[i]);
    EXPECT_THAT(differing_planes(again, first[i]), IsEmpty()) << "frame " << i << " after others";
  }
  for (std::size_t i : {1u, 2u})
    EXPECT_THAT(differing_planes(render_alone(meadow(), times[i]), first[i]), IsEmpty()) << "frame " << i << " alone";
}

TEST(Frame, IsTheSameOfAWorldThatIsBuiltAgain) {
  const World again = build_world(meadow_view());
  EXPECT_THAT(differing_planes(render_alone(again, 1.5), render_alone(meadow(), 1.5)), IsEmpty());
}

TEST(Frame, DoesNotDependOnTheOrigin) {
  Scene scene = meadow_view();
  scene.origin = {4.3e5, 9.2e6, 1.5e3};
  const Frame far = render_alone(build_world(scene), 1.5);
  EXPECT_EQ(far.origin, scene.origin);
  EXPECT_THAT(differing_planes(far, render_alone(meadow(), 1.5)), IsEmpty());
}

TEST(Frame, ForgetsMethodsThatAreNoLongerChosen) {
  Device device;
  FrameRunner runner(device, meadow());
  const Frame before = runner.render(0, 1.5);
  const std::uint64_t bytes = device.buffer_bytes();
  const Methods others[] = {
      {.tree = "ellipsoid-cap", .grass = "ambient", .crowns = "solid-angle", .occluders = "solid-angle-exact"},
      {.tree = "reeves-blau", .grass = "none", .crowns = "none", .occluders = "none"},
      {.tree = "none", .grass = "grass-height", .crowns = "solid-angle-exact", .occluders = "none"}};
  for (const Methods& methods : others) {
    runner.choose(methods);
    const Frame other = runner.render(0, 1.5);
    EXPECT_NE(other.visibility, before.visibility);
    EXPECT_EQ(other.depth, before.depth);
    EXPECT_EQ(other.owner, before.owner);
  }
  runner.choose(meadow().scene.methods);
  EXPECT_THAT(differing_planes(runner.render(0, 1.5), before), IsEmpty());
  EXPECT_EQ(device.buffer_bytes(), bytes) << "planes of the other methods are still there";
}

TEST(Frame, StatesItsMemoryAndGivesItBack) {
  Device device;
  {
    FrameRunner runner(device, meadow());
    runner.render(0, 0);
    // At least the posed vertices and ten planes of the picture.
    EXPECT_GT(device.buffer_bytes(), 10 * meadow().scene.image.width * meadow().scene.image.height * sizeof(float));
    EXPECT_LT(device.buffer_bytes(), 64u << 20);
  }
  EXPECT_EQ(device.buffer_bytes(), 0u);
  EXPECT_GT(device.peak_buffer_bytes(), 0u);
}

TEST(Frame, ShadesEveryFragmentWithinZeroAndOne) {
  for (double time : {0.0, 3.3}) {
    const Frame frame = render_alone(meadow(), time);
    std::size_t covered = 0, shaded = 0;
    for (std::size_t i = 0; i < frame.pixels(); ++i) {
      ASSERT_TRUE(frame.visibility[i] >= 0 && frame.visibility[i] <= 1) << frame.visibility[i];
      for (const auto& [name, plane] : frame.terms) ASSERT_TRUE(plane[i] >= 0 && plane[i] <= 1) << name << plane[i];
      ASSERT_LT(frame.owner[i], frame.owners.size());
      EXPECT_EQ(frame.owner[i] == 0, is_background(frame, i));
      if (is_background(frame, i)) {
        EXPECT_EQ(frame.visibility[i], 1);
        EXPECT_TRUE(std::isinf(frame.depth[i]));
      }
      covered += !is_background(frame, i);
      shaded += frame.visibility[i] < 0.9f;
    }
    EXPECT_GT(covered, frame.pixels() / 2);
    EXPECT_GT(shaded, frame.pixels() / 10);
  }
}

TEST(Frame, SeesEveryClassOfSurface) {
  const Frame frame = render_alone(meadow(), 0);
  std::map<SurfaceClass, int> pixels;
  for (const std::uint32_t owner : frame.owner) ++pixels[frame.owners[owner].surface];
  for (SurfaceClass surface : {SurfaceClass::background, SurfaceClass::terrain, SurfaceClass::leaf, SurfaceClass::wood,
                               SurfaceClass::blade, SurfaceClass::occluder})
    EXPECT_GT(pixels[surface], 5) << surface_class_name(surface);
}

TEST(Frame, KnowsHeightsOfBladesOnly) {
  const Frame frame = render_alone(meadow(), 1.5);
  for (std::size_t i = 0; i < frame.pixels(); ++i) {
    const bool blade = frame.owners[frame.owner[i]].surface == SurfaceClass::blade;
    if (!blade) {
      ASSERT_EQ(frame.height_above_root[i], 0);
    } else {
      // The ground is level and at 0: the height above the root is the height.
      ASSERT_NEAR(frame.height_above_root[i], frame.position[2][i], 1e-5);
      ASSERT_GE(frame.height_above_root[i], -1e-5);
    }
  }
}

}  // namespace
}  // namespace understory
