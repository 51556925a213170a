// Whole frames whose visibility is known on paper: open ground, a ball over it, a slope, a constant.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/pose.hpp"
#include "tests/support/frames.hpp"
#include "tests/support/temporary_file.hpp"

namespace understory {
namespace {

Frame render_one(const World& world) {
  Device device;
  return FrameRunner(device, world).render(0, 0);
}

std::size_t covered(const Frame& frame) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < frame.pixels(); ++i) count += !is_background(frame, i);
  return count;
}

TEST(FrameClosedForm, OpenGroundSeesTheWholeSky) {
  for (const double height : {0.0, 812.5}) {
    Scene scene = open_ground();
    scene.terrain.height = height;
    scene.camera.position.z += height;
    scene.camera.target.z += height;
    const Frame frame = render_one(build_world(scene));
    ASSERT_GT(covered(frame), frame.pixels() / 2);
    for (std::size_t i = 0; i < frame.pixels(); ++i) ASSERT_NEAR(frame.visibility[i], 1, 1e-6);
  }
}

TEST(FrameClosedForm, ASlopeSeesTheShareOfTheDomeBeforeIt) {
  for (const double degrees : {10.0, 35.0, 60.0}) {
    const double angle = degrees * 0.017453292519943295, rise = std::tan(angle);
    const std::string far = std::to_string(20 * rise);
    const TemporaryFile file("slope.obj", "v -20 -20 -" + far + "\nv 20 -20 -" + far + "\nv 20 20 " + far +
                                              "\nv -20 20 " + far + "\nf 1 2 3 4\n");
    Scene scene = open_ground();
    scene.terrain.kind = TerrainSource::Kind::mesh;
    scene.terrain.file = file.path();
    scene.camera.position = {0, -12, 6};
    const Frame frame = render_one(build_world(scene));
    ASSERT_GT(covered(frame), frame.pixels() / 2) << degrees;
    for (std::size_t i = 0; i < frame.pixels(); ++i) {
      if (is_background(frame, i)) continue;
      // The OBJ file holds heights to 1e-6 m over 40 m.
      ASSERT_NEAR(frame.visibility[i], 0.5 * (1 + std::cos(angle)), 1e-6) << degrees;
    }
  }
}

TEST(FrameClosedForm, PlantsOfConstantAmbientHaveThatConstant) {
  Scene scene = meadow_view();
  scene.sky = Sky::sphere;
  scene.occluders.clear();
  scene.methods = {.tree = "ambient", .grass = "ambient", .crowns = "none", .occluders = "none", .ambient = 0.37};
  const Frame frame = render_one(build_world(scene));
  std::size_t plants = 0;
  for (std::size_t i = 0; i < frame.pixels(); ++i) {
    const SurfaceClass surface = frame.owners[frame.owner[i]].surface;
    if (surface != SurfaceClass::leaf && surface != SurfaceClass::wood && surface != SurfaceClass::blade) continue;
    ASSERT_EQ(frame.visibility[i], 0.37f) << surface_class_name(surface);
    ++plants;
  }
  EXPECT_GT(plants, 100u);
}

/// A ball of 1 m over open ground, and what its sphere blocks for the ground at distance d from its centre, which
/// stands `s` above: (r/d)^2 s/d of V_c, half (r/d)^2 as the paper has it, the exact cone.
struct BallMethod {
  const char* name;
  double (*visibility)(double r, double d, double s);
};

const BallMethod ball_methods[] = {
    {"solid-angle-cosine", [](double r, double d, double s) { return 1 - s / d * (r / d) * (r / d); }},
    {"solid-angle", [](double r, double d, double) { return 1 - 0.5 * (r / d) * (r / d); }},
    {"solid-angle-exact", [](double r, double d, double) { return std::sqrt(1 - (r / d) * (r / d)); }},
};

class BallOverGround : public testing::TestWithParam<BallMethod> {};

std::string method_name(const testing::TestParamInfo<BallMethod>& method) {
  std::string name = method.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(Method, BallOverGround, testing::ValuesIn(ball_methods), method_name);

TEST_P(BallOverGround, DarkensItByTheClosedForm) {
  Scene scene = open_ground();
  OccluderSource ball;
  ball.name = "ball";
  OccluderPart& whole = ball.parts.emplace_back();
  whole.name = "ball";
  whole.shape = OccluderPart::Shape::ellipsoid;
  ball.keyframes = {{0, {0.3, 0.1, 0.8}, {0, 0, 0}}};
  scene.occluders.push_back(ball);
  scene.methods.occluders = GetParam().name;
  const World world = build_world(scene);
  const Pose pose = pose_at(world, 0, glm::dvec3(0));
  ASSERT_EQ(pose.spheres.size(), 1u) << "one sphere covers a ball";
  const glm::dvec3 centre(pose.spheres[0].centre);
  const double radius = pose.spheres[0].radius;
  EXPECT_NEAR(radius, 0.5, 0.01);
  EXPECT_LT(glm::distance(centre, {0.3, 0.1, 0.8}), 0.01);

  const Frame frame = render_one(world);
  double darkest = 1;
  for (std::size_t i = 0; i < frame.pixels(); ++i) {
    if (frame.owners[frame.owner[i]].surface != SurfaceClass::terrain) continue;
    const glm::dvec3 to_centre = centre - position_at(frame, i);
    const double expected = GetParam().visibility(radius, glm::length(to_centre), to_centre.z);
    // Far from the ball its share may be approximated by at most a quarter of an 8-bit step (host/passes/solid_angle).
    const double error = expected < 0.98 ? 1e-5 : 1.0 / 1020 + 1e-5;
    ASSERT_NEAR(frame.visibility[i], expected, error) << glm::length(to_centre);
    darkest = std::min(darkest, expected);
  }
  EXPECT_LT(darkest, 0.9) << "no ground near the ball is in view";
}

}  // namespace
}  // namespace understory
