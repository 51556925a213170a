// The near field in whole frames: the guard band, half resolution and blur, orthographic planes of other programs.
#include <gtest/gtest.h>

#include "host/frame/near_field.hpp"
#include "host/trace/frame_truth.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/fragments.hpp"
#include "tests/support/frames.hpp"

namespace understory {
namespace {

Scene near_view() {
  Scene scene = meadow_view();
  scene.methods.near = "obscurance-line";
  scene.methods.near_field.radius = 0.3;
  return scene;
}

Frame render(const Scene& scene) {
  const World world = build_world(scene);
  Device device;
  return FrameRunner(device, world).render(0, 0.5);
}

std::size_t flagged(const Frame& frame, std::uint32_t code) {
  std::size_t count = 0;
  for (const std::uint32_t v : frame.validity) count += (v & code) != 0;
  return count;
}

TEST(NearField, AGuardBandKeepsSamplesInsideAndTheImageAsItIs) {
  UNDERSTORY_NEEDS_DEVICE();
  Scene scene = near_view();
  const Frame without = render(scene);
  scene.methods.near_field.guard = 100;
  const Frame with = render(scene);
  EXPECT_GT(flagged(without, validity::left_image), 100u);
  EXPECT_EQ(flagged(with, validity::left_image), 0u);
  ASSERT_EQ(with.pixels(), without.pixels());
  std::size_t different = 0;
  for (std::size_t i = 0; i < with.pixels(); ++i) {
    different += with.owner[i] != without.owner[i];
    if (with.owner[i] != without.owner[i]) continue;
    if (!is_background(with, i)) {
      EXPECT_NEAR(with.depth[i], without.depth[i], 1e-3 * without.depth[i]);
    }
  }
  // A larger principal point rounds rays by a hair: an edge may move over a pixel's centre.
  EXPECT_LT(different, with.pixels() / 500);
}

TEST(NearField, DarkensWhatIsCloseTogetherAndNothingElse) {
  UNDERSTORY_NEEDS_DEVICE();
  Scene scene = near_view();
  const Frame near = render(scene);
  scene.methods.near = "none";
  const Frame none = render(scene);
  double sum = 0;
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < near.pixels(); ++i) {
    EXPECT_LE(near.visibility[i], none.visibility[i] + 1e-6f);
    if (near.validity[i] & validity::background) continue;
    sum += static_cast<double>(near.terms.at("obscurance-line")[i]);
    ++drawn;
  }
  EXPECT_GT(sum / static_cast<double>(drawn), 0.3);
  EXPECT_LT(sum / static_cast<double>(drawn), 0.98);
  EXPECT_FALSE(none.terms.contains("obscurance-line"));
}

TEST(NearField, MinimumIsNeverDarkerThanProduct) {
  UNDERSTORY_NEEDS_DEVICE();
  Scene scene = near_view();
  const Frame product = render(scene);
  scene.methods.near_field.combine = "minimum";
  const Frame minimum = render(scene);
  for (std::size_t i = 0; i < product.pixels(); ++i) {
    EXPECT_GE(minimum.visibility[i], product.visibility[i]);
    EXPECT_LE(minimum.visibility[i], product.terms.at("obscurance-line")[i]);
  }
}

TEST(NearField, RaysAreNearerToTracedOnesThanLines) {
  UNDERSTORY_NEEDS_DEVICE();
  Scene scene = meadow_view();
  scene.methods.near_field.radius = 1;
  scene.methods.near_field.blur = 2;
  const World world = build_world(scene);
  Device device;
  FrameRunner runner(device, world);
  Frame truth = runner.render(0, 0.5);
  trace_frame(tracer_of(runner.posed_geometry()), {.rays = 64, .max_distance = 1}, truth);
  const auto error_of = [&](const char* method, const char* falloff) {
    Methods methods = scene.methods;
    methods.near = method;
    methods.near_field.falloff = falloff;
    methods.near_field.samples = 16;
    runner.choose(methods);
    const Frame near = runner.render(0, 0.5);
    double sum = 0, drawn = 0;
    for (std::size_t i = 0; i < near.pixels(); ++i) {
      if (is_background(near, i)) continue;
      sum += std::pow(static_cast<double>(near.terms.at(method)[i]) - static_cast<double>(truth.visibility[i]), 2);
      ++drawn;
    }
    return std::sqrt(sum / drawn);
  };
  const double rays = error_of("screen-rays", "constant");
  EXPECT_LT(rays, 0.9 * error_of("obscurance-line", "cosine")) << rays;
  EXPECT_LT(rays, 0.9 * error_of("obscurance-line", "constant")) << rays;
}

/// A step of two levels seen from above by an orthographic camera, 20 pixels a metre.
Frame orthographic_step() {
  Frame frame;
  frame.width = 60;
  frame.height = 40;
  frame.orthographic_height = 2;
  frame.world_to_camera[3][2] = -10;  // 10 m above z = 0, looking down
  frame.owners.assign(1, Owner{});
  for (int i = 0; i < 60 * 40; ++i) {
    const int x = i % 60, y = i / 60;
    const float top = x < 30 ? 0.0f : 1.0f;
    frame.position[0].push_back((static_cast<float>(x) + 0.5f - 30) / 20);
    frame.position[1].push_back(-(static_cast<float>(y) + 0.5f - 20) / 20);
    frame.position[2].push_back(top);
    frame.normal[0].push_back(0);
    frame.normal[1].push_back(0);
    frame.normal[2].push_back(1);
    frame.depth.push_back(10 - top);
    frame.owner.push_back(0);
    frame.validity.push_back(0);
  }
  return frame;
}

TEST(NearField, OfOrthographicPlanesNeedsNoScene) {
  UNDERSTORY_NEEDS_DEVICE();
  Methods methods{.tree = "none", .grass = "none", .crowns = "none", .occluders = "none"};
  methods.near = "obscurance-line";
  methods.near_field.radius = 0.5;  // 10 pixels
  Frame frame = orthographic_step();
  Device device;
  shade_planes(device, nullptr, methods, 0, frame);
  EXPECT_NEAR(frame.visibility[20 * 60 + 15], 1, 1e-6) << "far from the step";
  EXPECT_LT(frame.visibility[20 * 60 + 29], 0.7) << "at its foot: half, and a little of what is far behind its top";
  EXPECT_NEAR(frame.visibility[20 * 60 + 30], 1, 1e-6) << "on its edge";
  frame = orthographic_step();
  frame.orthographic_height = 0;
  EXPECT_NE(message_of(ErrorKind::invalid_input, [&] { shade_planes(device, nullptr, methods, 0, frame); })
                .find("field of view or, orthographic"),
            std::string::npos);
}

}  // namespace
}  // namespace understory
