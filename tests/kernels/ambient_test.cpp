// ambient: the constant by class, and the ground's visibility under grass against bilinear interpolation in double.
#include "host/passes/ambient.hpp"

#include <gtest/gtest.h>

#include "tests/support/fragments.hpp"
#include "tests/support/tolerances.hpp"

namespace understory {
namespace {

const glm::dvec3 eye(500000.25, 4000000.5, 800);  // far from the origin, as in a projected coordinate system

GroundCover random_cover() {
  GroundCover cover;
  cover.extent = {{eye.x - 20, eye.y - 10}, {eye.x + 30, eye.y + 40}};
  cover.columns = 25;
  cover.rows = 17;
  Random random(13, stream_of("cover"));
  for (std::uint32_t i = 0; i < cover.columns * cover.rows; ++i)
    cover.visibility.push_back(static_cast<float>(random.uniform()));
  return cover;
}

/// `p`: relative to the origin.
double bilinear(const GroundCover& cover, glm::dvec2 p) {
  if (!cover.extent.contains(p)) return 1;
  const glm::dvec2 cells(cover.columns, cover.rows), size = cover.extent.high - cover.extent.low;
  const glm::dvec2 at = glm::clamp((p - cover.extent.low) / size * cells - 0.5, glm::dvec2(0), cells - 1.0);
  const auto value = [&](double column, double row) {
    const auto c = static_cast<std::size_t>(std::min(column, cells.x - 1)),
               r = static_cast<std::size_t>(std::min(row, cells.y - 1));
    return static_cast<double>(cover.visibility[r * cover.columns + c]);
  };
  const glm::dvec2 low = glm::floor(at), f = at - low;
  return (1 - f.y) * ((1 - f.x) * value(low.x, low.y) + f.x * value(low.x + 1, low.y)) +
         f.y * ((1 - f.x) * value(low.x, low.y + 1) + f.x * value(low.x + 1, low.y + 1));
}

// Owners: 0 background, 1 leaf, 2 terrain, 3 blade.
OwnerTables owners_of_three(Device& device) {
  std::vector<Owner> owners(4);
  owners[1].surface = SurfaceClass::leaf;
  owners[2].surface = SurfaceClass::terrain;
  owners[3].surface = SurfaceClass::blade;
  return upload_owners(device, owners);
}

Shaded shade(const std::vector<TestFragment>& fragments, const GroundCover& cover) {
  return shade_everywhere(fragments, [&](Device& device, int lanes, FragmentPlanes& planes, Buffer<float>& visibility) {
    AmbientPass(device, lanes)
        .run(planes, owners_of_three(device), 0.375, class_bit(SurfaceClass::leaf), GroundCoverTable(device, cover),
             eye, visibility);
  });
}

TEST(Ambient, IsTheConstantTheGroundOrOne) {
  UNDERSTORY_NEEDS_DEVICE();
  const GroundCover cover = random_cover();
  for (const std::size_t size : odd_sizes) {
    std::vector<TestFragment> fragments;
    for (std::size_t i = 0; i < size; ++i) {
      Random random(14, stream_of("ground"), i);
      TestFragment f;
      f.position = glm::vec3(random.uniform(-25, 35), random.uniform(-15, 45), -2);
      f.owner = static_cast<std::uint32_t>(1 + random.below(3));
      fragments.push_back(f);
    }
    const Shaded shaded = shade(fragments, cover);
    for (std::size_t i = 0; i < size; ++i) {
      const double expected[] = {1, 0.375, bilinear(cover, glm::dvec2(eye) + glm::dvec2(fragments[i].position)), 1};
      EXPECT_NEAR(shaded.visibility[i], expected[fragments[i].owner], tolerance::ground_cover) << i;
    }
  }
}

TEST(Ambient, GroundWithoutGrassIsOpen) {
  UNDERSTORY_NEEDS_DEVICE();
  std::vector<TestFragment> fragments(3);
  for (TestFragment& f : fragments) f.owner = 2;
  EXPECT_EQ(shade(fragments, GroundCover()).visibility, std::vector<float>(3, 1.0f));
}

TEST(Ambient, GarbageStaysWithinBounds) {
  UNDERSTORY_NEEDS_DEVICE();
  GroundCover cover = random_cover();
  cover.visibility[0] = NAN;
  std::vector<TestFragment> fragments = garbage(4);
  for (TestFragment& f : fragments) f.owner = 2;
  shade(fragments, cover);  // expects [0, 1]
}

}  // namespace
}  // namespace understory
