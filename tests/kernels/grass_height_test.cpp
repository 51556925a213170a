// grass-height and open-dome: eq. 9 of Hegeman et al. 2006 and its dome factor, counted, and the device against double.
#include "host/passes/grass_height.hpp"

#include <gtest/gtest.h>

#include "host/passes/open_dome.hpp"
#include "kernels/shared/grass_height.h"
#include "kernels/shared/open_dome.h"
#include "tests/reference/grass_height.hpp"
#include "tests/support/fragments.hpp"
#include "tests/support/tolerances.hpp"

namespace understory {
namespace {

// Owners: 0 background, 1 blade, 2 terrain.
OwnerTables grass_owners(Device& device) {
  std::vector<Owner> owners(3);
  owners[1].surface = SurfaceClass::blade;
  owners[2].surface = SurfaceClass::terrain;
  return upload_owners(device, owners);
}

Shaded shade(const std::vector<TestFragment>& fragments) {
  return shade_everywhere(fragments, [](Device& device, int lanes, FragmentPlanes& planes, Buffer<float>& visibility) {
    GrassHeightPass(device, lanes).run(planes, grass_owners(device), visibility);
  });
}

std::vector<TestFragment> blades(std::size_t count) {
  std::vector<TestFragment> all;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(4, stream_of("blade"), i);
    TestFragment f;
    f.normal = random_direction(random);
    f.owner = static_cast<std::uint32_t>(1 + i % 3 / 2);
    f.blade_length = static_cast<float>(random.uniform(0.05, 1.5));
    f.height = f.blade_length * static_cast<float>(random.uniform(-0.2, 1.2));
    all.push_back(f);
  }
  return all;
}

TEST(OpenDome, IsTheCountedShareOfTheSkyAboveTheHorizon) {
  // Directions in equal shares of the cosine-weighted hemisphere of a normal tilted by t, about the x axis.
  for (const double tilt : {0.0, 0.4, std::numbers::pi / 2, 2.5, std::numbers::pi}) {
    constexpr int side = 1000;
    int above = 0;
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j) {
        const double sine = std::sqrt((i + 0.5) / side), turn = 2 * std::numbers::pi * (j + 0.5) / side;
        const double cosine = std::sqrt(1 - sine * sine);
        if (sine * std::sin(turn) * std::sin(tilt) + cosine * std::cos(tilt) > 0) ++above;
      }
    EXPECT_NEAR(open_dome(std::cos(tilt)), above / double(side * side), 2 * tolerance::ray_counting) << tilt;
  }
}

TEST(OpenDome, DeviceIsTheReference) {
  UNDERSTORY_NEEDS_DEVICE();
  for (const std::size_t size : odd_sizes) {
    const std::vector<TestFragment> fragments = blades(size);
    const Shaded shaded =
        shade_everywhere(fragments, [](Device& device, int lanes, FragmentPlanes& planes, Buffer<float>& visibility) {
          OpenDomePass(device, lanes).run(planes, visibility);
        });
    for (std::size_t i = 0; i < size; ++i)
      EXPECT_NEAR(shaded.visibility[i], reference::open_dome(double(fragments[i].normal.z)), tolerance::open_dome);
  }
}

TEST(GrassHeight, ClosedForms) {
  UNDERSTORY_NEEDS_DEVICE();
  const glm::vec3 up(0, 0, 1), level(1, 0, 0), down(0, 0, -1);
  const Shaded shaded = shade({{{}, up, 1, 0.5f, 0.5f},       // tip: open
                               {{}, up, 1, 0.0f, 0.5f},       // root: dark
                               {{}, level, 1, 0.25f, 0.5f},   // half way: half, whatever way it faces
                               {{}, down, 1, 0.5f, 0.5f},     // the horizon is the dome's
                               {{}, up, 1, 0.7f, 0.5f},       // above its own tip: clamped
                               {{}, level, 1, 0.0f, 0.0f},    // no height: nothing covers it
                               {{}, level, 2, 0.1f, 0.5f}});  // terrain is another model's
  EXPECT_EQ(shaded.visibility, (std::vector<float>{1, 0, 0.5f, 1, 1, 1, 1}));
  const std::uint32_t outside = validity::outside_model;
  EXPECT_EQ(shaded.validity, (std::vector<std::uint32_t>{0, 0, 0, 0, outside, outside, 0}));
}

TEST(GrassHeight, DeviceIsTheReference) {
  UNDERSTORY_NEEDS_DEVICE();
  for (const std::size_t size : odd_sizes) {
    const std::vector<TestFragment> fragments = blades(size);
    const Shaded shaded = shade(fragments);
    for (std::size_t i = 0; i < size; ++i) {
      const TestFragment& f = fragments[i];
      const double exact = f.owner == 1 ? reference::grass_height(double(f.height), double(f.blade_length)) : 1.0;
      EXPECT_NEAR(shaded.visibility[i], exact, tolerance::grass);
    }
  }
}

TEST(GrassHeight, TimesTheDomeIsEquation9AsPrinted) {
  for (const double tilt : {0.0, 0.7, 1.9})
    for (const double height : {0.0, 0.1, 0.4})
      EXPECT_NEAR(grass_height(height, 0.4) * open_dome(std::cos(tilt)), height / (2 * 0.4) * (1 + std::cos(tilt)),
                  1e-12);
}

TEST(GrassHeight, HigherIsNeverDarker) {
  for (int i = 0; i < 1000; ++i) EXPECT_LE(grass_height(i * 1e-3, 0.9), grass_height((i + 1) * 1e-3, 0.9));
}

TEST(GrassHeight, GarbageStaysWithinBounds) {
  UNDERSTORY_NEEDS_DEVICE();
  shade(garbage(3));  // expects [0, 1]
}

}  // namespace
}  // namespace understory
