// reeves-blau: closed forms, and the device against double.
#include "host/passes/reeves_blau.hpp"

#include <gtest/gtest.h>

#include "tests/reference/reeves_blau.hpp"
#include "tests/support/crowns.hpp"
#include "tests/support/tolerances.hpp"

namespace understory {
namespace {

Shaded shade(const std::vector<TestFragment>& fragments, const std::vector<TestCrown>& crowns) {
  return shade_everywhere(fragments, [&](Device& device, int lanes, FragmentPlanes& planes, Buffer<float>& visibility) {
    ReevesBlauPass(device, lanes)
        .run(planes, crown_owners(device, crowns.size()), upload_crowns(device, crowns), visibility);
  });
}

TEST(ReevesBlau, ClosedForms) {
  UNDERSTORY_NEEDS_DEVICE();
  TestCrown crown;
  crown.centre = {0, 0, 4};
  crown.radius = 3;
  crown.ambient = 0.75;
  crown.extinction = 0.5;
  // At the centre, half way out, on the surface, outside.
  const std::vector<TestFragment> fragments = {
      {{0, 0, 4}, {0, 0, 1}, 1}, {{1.5f, 0, 4}, {0, 0, 1}, 1}, {{0, 3, 4}, {0, 0, 1}, 1}, {{0, 0, 9}, {0, 0, 1}, 1}};
  const Shaded shaded = shade(fragments, {crown});
  EXPECT_NEAR(shaded.visibility[0], 0.75 * std::exp(-1.5), tolerance::exp_minus);
  EXPECT_NEAR(shaded.visibility[1], 0.75 * std::exp(-0.75), tolerance::exp_minus);
  EXPECT_NEAR(shaded.visibility[2], 0.75, tolerance::exp_minus);
  EXPECT_NEAR(shaded.visibility[3], 0.75, tolerance::exp_minus);
  EXPECT_EQ(shaded.validity, (std::vector<std::uint32_t>{0, 0, 0, validity::outside_model}));
}

TEST(ReevesBlau, DeviceIsTheReference) {
  UNDERSTORY_NEEDS_DEVICE();
  const std::vector<TestCrown> crowns = random_crowns(7);
  for (const std::size_t size : odd_sizes) {
    const std::vector<TestFragment> fragments = crown_fragments(size, crowns);
    const Shaded shaded = shade(fragments, crowns);
    for (std::size_t i = 0; i < size; ++i) {
      const TestFragment& f = fragments[i];
      if (f.owner > crowns.size()) {
        EXPECT_EQ(shaded.visibility[i], 1);
        continue;
      }
      const TestCrown& crown = crowns[f.owner - 1];
      const glm::dvec3 p = glm::dvec3(f.position) - crown.centre;
      EXPECT_NEAR(shaded.visibility[i], reference::reeves_blau(p, crown.radius, crown.ambient, crown.extinction),
                  tolerance::crown);
    }
  }
}

TEST(ReevesBlau, GarbageStaysWithinBounds) {
  UNDERSTORY_NEEDS_DEVICE();
  std::vector<TestCrown> crowns = random_crowns(4);
  crowns[0].ambient = 0.3;
  crowns[1].radius = INFINITY;
  crowns[2].extinction = NAN;
  crowns[3].ambient = -INFINITY;
  const std::vector<TestFragment> fragments = garbage(6);
  const Shaded shaded = shade(fragments, crowns);
  for (std::size_t i = 0; i < fragments.size(); ++i)
    if (std::isnan(fragments[i].position.x)) {
      EXPECT_EQ(shaded.visibility[i], 1);
    }
}

}  // namespace
}  // namespace understory
