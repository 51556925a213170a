// A scene at UTM coordinates, without an `origin`, gives the image of the same scene at zero.
#include <gmock/gmock.h>

#include <cmath>

#include "sim/files/local_origin.hpp"
#include "sim/files/scene_file.hpp"
#include "tests/support/fragments.hpp"
#include "tests/support/frames.hpp"
#include "tests/support/temporary_file.hpp"

namespace understory {
namespace {

constexpr glm::dvec2 utm(500'000, 5'400'000);

/// The scene with `by` added to all positions, as somebody would have written it.
Scene written_at(Scene scene, glm::dvec2 by) {
  move_zero(scene, -by);
  scene.origin = glm::dvec3(0);
  return load_scene(TemporaryFile("far.json", resolved_scene(scene)).path());
}

struct Difference {
  double differing = 0;  // share of all pixels where V differs by more than 1e-4 or another owner is seen
  std::size_t covered = 0;
};

Difference difference_of(const Frame& a, const Frame& b) {
  Difference difference;
  for (std::size_t i = 0; i < a.pixels(); ++i) {
    difference.covered += a.owner[i] != 0;
    difference.differing += a.owner[i] != b.owner[i] || std::abs(a.visibility[i] - b.visibility[i]) > 1e-4f;
  }
  difference.differing /= static_cast<double>(a.pixels());
  return difference;
}

void expect_same_image(Scene scene, glm::dvec2 by) {
  Device device;
  // Read back from text too, so that only the coordinates differ.
  const World here = build_world(written_at(scene, glm::dvec2(0))), there = build_world(written_at(scene, by));
  EXPECT_EQ(there.scene.origin, glm::dvec3(by, 0));
  FrameRunner near(device, here), far(device, there);
  for (const double time : {0.0, 3.7}) {
    const Frame expected = near.render(0, time), seen = far.render(0, time);
    const Difference difference = difference_of(expected, seen);
    EXPECT_GT(difference.covered, expected.pixels() / 2);
    EXPECT_LE(difference.differing, 1e-3) << scene.name << " at " << time << " s";
    EXPECT_EQ(seen.origin, glm::dvec3(by, 0));
  }
}

TEST(LargeCoordinates, GiveTheImageOfAMeadow) {
  UNDERSTORY_NEEDS_DEVICE();
  Scene scene = meadow_view();
  scene.image = {160, 100};
  expect_same_image(scene, utm);
  scene.methods.grass = "grass-transmittance";
  scene.methods.tree = "crown-transmittance";
  expect_same_image(scene, utm);
}

TEST(LargeCoordinates, GiveTheImageOfAPlantAndItsTerrain) {
  UNDERSTORY_NEEDS_DEVICE();
  Scene scene = one_plant(small_species("broadleaf", 5000), {1.3, 2.1});
  scene.image = {160, 100};
  scene.camera.position = {2, -9, 2.5};
  scene.camera.target = {1, 2, 3};
  scene.methods.tree = "ellipsoid-cap";
  expect_same_image(scene, utm);
  expect_same_image(scene, {-9'999'000, 10'000'000});
}

}  // namespace
}  // namespace understory
