// An environment map in a frame: planned only where the scene has one, and a constant one lights by V.
#include <gmock/gmock.h>

#include "tests/support/environments.hpp"
#include "tests/support/frames.hpp"

namespace understory {
namespace {

TEST(EnvironmentFrame, WithoutAMapNothingOfItExists) {
  const World world = build_world(meadow_view());
  Device device;
  FrameRunner runner(device, world);
  const Frame frame = runner.render(0, 0.5);
  EXPECT_FALSE(runner.plan().has("environment"));
  EXPECT_TRUE(frame.ambient_light[0].empty());
  EXPECT_THAT(device.programs_built(), testing::Not(testing::Contains("environment")));
}

TEST(EnvironmentFrame, AConstantMapLightsByVisibility) {
  World world = build_world(meadow_view());
  world.environment = std::make_shared<const EnvironmentMap>(constant_environment({0.5f, 2, 8}));
  for (const double gloss : {0.0, 0.3}) {
    world.scene.environment.gloss = gloss;
    Device device;
    FrameRunner runner(device, world);
    const Frame frame = runner.render(0, 0.5);
    ASSERT_TRUE(runner.plan().has("environment"));
    EXPECT_TRUE(frame.pass_ms.contains("environment"));
    EXPECT_NEAR(frame.sky_mean.y, 2, 1e-5);
    for (std::size_t i = 0; i < frame.pixels(); ++i) {
      const bool background = (frame.validity[i] & validity::background) != 0;
      if (!background && gloss > 0 && frame.owners[frame.owner[i]].surface == SurfaceClass::occluder) continue;
      for (std::size_t channel = 0; channel < 3; ++channel) {
        const float radiance = std::array{0.5f, 2.0f, 8.0f}[channel];
        ASSERT_NEAR(frame.ambient_light[channel][i], background ? 0 : radiance * frame.visibility[i], 1e-5 * radiance);
      }
    }
  }
}

}  // namespace
}  // namespace understory
