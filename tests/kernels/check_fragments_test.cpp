// check-fragments: which fragments of a foreign image are flagged, and that normals come out unit.
#include "host/passes/check_fragments.hpp"

#include <gtest/gtest.h>

#include "tests/support/fragments.hpp"

namespace understory {
namespace {

struct Checked {
  std::vector<glm::vec3> normals;
  std::vector<std::uint32_t> validity;
};

Checked check(const std::vector<TestFragment>& fragments, int lanes) {
  Device device;
  FragmentPlanes planes = upload_fragments(device, fragments);
  CheckFragmentsPass(device, lanes).run(planes);
  const auto x = planes.normal_x.read(), y = planes.normal_y.read(), z = planes.normal_z.read();
  Checked checked{{}, first_of(planes.validity, fragments.size())};
  for (std::size_t i = 0; i < fragments.size(); ++i) checked.normals.push_back({x[i], y[i], z[i]});
  return checked;
}

TEST(CheckFragments, FlagsAndMends) {
  UNDERSTORY_NEEDS_DEVICE();
  const glm::vec3 up(0, 0, 1);
  const std::vector<TestFragment> fragments = {{{1, 2, 3}, up},
                                               {{NAN, 2, 3}, up},
                                               {{1, -INFINITY, 3}, up},
                                               {{1, 2, 3}, {0, NAN, 1}},
                                               {{1, 2, 3}, {0, 0, 0}},
                                               {{1, 2, 3}, {0, 3, 4}},
                                               {{1, 2, 3}, {1e30f, 0, 1e30f}},
                                               {{1, 2, 3}, {0, -1e-20f, 0}},
                                               {{NAN, 2, 3}, {0, 0, 2}, 0, 0, 0, validity::background}};
  const std::uint32_t lost = validity::not_finite, mended = validity::not_unit;
  for (const int lanes : lane_counts) {
    const Checked checked = check(fragments, lanes);
    EXPECT_EQ(checked.validity,
              (std::vector<std::uint32_t>{0, lost, lost, lost, lost, mended, mended, mended, validity::background}));
    EXPECT_EQ(checked.normals[0], up);
    EXPECT_NEAR(glm::length(checked.normals[5] - glm::vec3(0, 0.6f, 0.8f)), 0, 1e-6);
    EXPECT_NEAR(checked.normals[6].z, std::sqrt(0.5), 1e-6);
    EXPECT_EQ(checked.normals[7], glm::vec3(0, -1, 0));
    EXPECT_EQ(checked.normals[8], glm::vec3(0, 0, 2));
  }
}

TEST(CheckFragments, HalfFloatNormalsPass) {
  UNDERSTORY_NEEDS_DEVICE();
  std::vector<TestFragment> fragments;
  for (std::size_t i = 0; i < 1003; ++i) {
    Random random(15, stream_of("half"), i);
    TestFragment f;
    f.normal = random_direction(random);
    for (int axis = 0; axis < 3; ++axis) f.normal[axis] = std::round(f.normal[axis] * 2048) / 2048;
    fragments.push_back(f);
  }
  EXPECT_EQ(check(fragments, 0).validity, std::vector<std::uint32_t>(1003, 0));
}

}  // namespace
}  // namespace understory
