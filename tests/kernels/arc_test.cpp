// shared/arc.h against the C++ library: its text in double over the whole stated domain, and on every device at every
// vector width through `pose_mesh`, which is these functions and two transforms.
#include "kernels/shared/arc.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/random.hpp"
#include "tests/support/meshes.hpp"
#include "tests/support/pose_on_device.hpp"

namespace understory {
namespace {

constexpr double largest_angle = 2.5;  // radians, as arc.h says
constexpr double arc_error = 1e-6, sine_error = 2e-6;

double sinc(double f) { return f == 0 ? 1 : std::sin(f) / f; }
/// (1 - cos f)/f^2 without cancellation.
double versine(double f) { return 0.5 * sinc(f / 2) * sinc(f / 2); }

TEST(Arc, DoubleTextIsSineAndVersineOverTheWholeDomain) {
  for (int i = 0; i <= 100000; ++i) {
    const double f = largest_angle * i / 100000;
    ASSERT_NEAR(arc_sine(f * f), sinc(f), arc_error) << f;
    ASSERT_NEAR(arc_versine(f * f), versine(f), arc_error) << f;
  }
}

TEST(Arc, IsExactWithoutBend) {
  EXPECT_EQ(arc_sine(0), 1);
  EXPECT_EQ(arc_versine(0), 0.5);
  for (double turns : {0.0, 1.0, -3.0, 1048575.0}) EXPECT_EQ(sine_of_turns(turns), 0);
}

TEST(Arc, DoubleTextOfSineOfTurnsHoldsForAnyTurns) {
  Random random(5, 1);
  for (int i = 0; i < 100000; ++i) {
    const double turns = random.uniform(-1048576, 1048576), part = turns - std::rint(turns);
    ASSERT_NEAR(sine_of_turns(turns), std::sin(2 * std::numbers::pi * part), sine_error) << turns;
  }
}

class ArcOnDevice : public testing::TestWithParam<int> {
 protected:
  int lanes() const { return GetParam(); }
};
INSTANTIATE_TEST_SUITE_P(Width, ArcOnDevice, testing::ValuesIn(vector_widths));

/// Blocks that use one rest block and one limb each, in order.
std::vector<PosedBlock> in_order(std::size_t blocks) {
  std::vector<PosedBlock> all;
  for (std::uint32_t i = 0; i < blocks; ++i) all.push_back({i, i});
  return all;
}

VertexBlocks resting_points(const std::vector<float>& x) {
  VertexBlocks rest;
  rest.x = x;
  rest.y = rest.z = std::vector<float>(x.size(), 0);
  rest.flutter_x = std::vector<std::int8_t>(x.size(), 1);
  rest.flutter_y = rest.flutter_z = std::vector<std::int8_t>(x.size(), 0);
  rest.flutter_phase = std::vector<std::uint8_t>(x.size(), 0);
  return rest;
}

TEST_P(ArcOnDevice, BendsByItsStatedError) {
  // Curvature 1 takes (s, 0, 0) to (s sinc(s), s^2 versine(s), 0).
  std::vector<float> s;
  for (int i = 0; i < 63 * 16; ++i) s.push_back(static_cast<float>(largest_angle * (2.0 * (i + 1) / (63 * 16) - 1)));
  LimbPose bent = standing_limb();
  bent.curvature = 1;
  for (const DeviceInfo& info : list_devices()) {
    Device device(std::to_string(info.index));
    const Points posed =
        pose_mesh_on(device, lanes(), resting_points(s), in_order(63), std::vector<LimbPose>(63, bent));
    for (std::size_t i = 0; i < s.size(); ++i) {
      const double f = s[i];
      if (f == 0) continue;
      ASSERT_NEAR(posed.x[i] / f, sinc(f), arc_error) << f << " on " << info.name;
      ASSERT_NEAR(posed.y[i] / (f * f), versine(f), arc_error) << f << " on " << info.name;
    }
  }
}

TEST_P(ArcOnDevice, TakesTheSineOfAnyTurns) {
  // A vertex at the origin that flutters along x by 1 m is the sine itself.
  Random random(6, 1);
  std::vector<LimbPose> limbs;
  std::vector<double> expected;
  for (int i = 0; i < 61; ++i) {
    LimbPose limb = standing_limb();
    limb.flutter_amplitude = 1;
    limb.flutter_phase = static_cast<float>(random.uniform(-1, 1) * std::pow(10, random.uniform(-2, 6.8)));
    limbs.push_back(limb);
    const double turns = limb.flutter_phase * 0.15915494f;  // the float product that the kernel forms
    ASSERT_LT(std::abs(turns), 1048576);
    expected.push_back(std::sin(2 * std::numbers::pi * (turns - std::rint(turns))));
  }
  for (const DeviceInfo& info : list_devices()) {
    Device device(std::to_string(info.index));
    const Points posed =
        pose_mesh_on(device, lanes(), resting_points(std::vector<float>(61 * 16, 0)), in_order(61), limbs);
    for (std::size_t i = 0; i < posed.x.size(); ++i)
      ASSERT_NEAR(posed.x[i], expected[i / 16], sine_error) << limbs[i / 16].flutter_phase << " on " << info.name;
  }
}

}  // namespace
}  // namespace understory
