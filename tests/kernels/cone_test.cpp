// T_clip and T_merge of kernels/shared/cone.h, in double: closed forms against quadrature over directions.
#include "kernels/shared/cone.h"

#include <gtest/gtest.h>

#include <glm/glm.hpp>

#include "sim/random.hpp"
#include "tests/reference/cone.hpp"

namespace understory {
namespace {

const double pi = std::numbers::pi;
/// Of the polynomial arc tangents.
constexpr double closed_form = 2e-6;
/// Of 1200 rings of 2400 directions: the boundary of a cone crosses some 4000 of 3 million cells.
constexpr double counting = 1e-3;

TEST(Cone, ClosedForms) {
  for (const double h : {0.1, 0.5, 1.0, pi / 2, 2.0, 3.0}) {
    const double aperture = (1 - std::cos(h)) / 2, square = std::sin(h) * std::sin(h);
    const double whole = h <= pi / 2 ? square : 1;  // about the normal
    EXPECT_NEAR(clip_cosine(aperture, 1), whole, closed_form) << h;
    EXPECT_NEAR(clip_cosine(aperture, -1), h <= pi / 2 ? 0 : 1 - square, closed_form) << h;
    EXPECT_NEAR(clip_solid_angle(aperture, 1), std::min(aperture, 0.5), closed_form) << h;
    EXPECT_NEAR(clip_solid_angle(aperture, 0), aperture / 2, closed_form) << h;
    // Along the plane: half of the cone of directions is above it.
    EXPECT_NEAR(clip_cosine(aperture, 0), (h - std::sin(h) * std::cos(h)) / pi, closed_form) << h;
  }
  for (const double b : {0.0, 0.3, 1.0, 2.0, pi}) {  // a half-space
    EXPECT_NEAR(clip_cosine(0.5, std::cos(b)), (1 + std::cos(b)) / 2, closed_form);
    EXPECT_NEAR(clip_solid_angle(0.5, std::cos(b)), (pi - b) / (2 * pi), closed_form);
    EXPECT_NEAR(overlap_of_apertures(0.5, 0.5, std::cos(b)), (pi - b) / (2 * pi), closed_form);
  }
  EXPECT_EQ(clip_cosine(0, 0.5), 0);
  EXPECT_EQ(clip_solid_angle(0, 0.5), 0);
  EXPECT_NEAR(clip_cosine(1, 0.5), 1, closed_form);
}

TEST(Cone, ClipIsTheQuadrature) {
  for (int i = 0; i < 60; ++i) {
    Random random(3, stream_of("clip"), static_cast<std::uint64_t>(i));
    const double aperture = random.uniform(0.001, 0.97), b = random.uniform(0, pi);
    const reference::DirectionSums sums = reference::clipped_cone(aperture, b, 500);
    ASSERT_NEAR(clip_cosine(aperture, std::cos(b)), sums.cosine, 3 * counting) << aperture << ' ' << b;
    ASSERT_NEAR(clip_solid_angle(aperture, std::cos(b)), sums.solid_angle, 3 * counting) << aperture << ' ' << b;
    // f d + (1 - f) n points where the sum of directions does.
    const double f = clip_blend(aperture, std::cos(b)), length = glm::length(sums.direction);
    const glm::dvec3 axis = f * glm::dvec3(std::sin(b), 0, std::cos(b)) + (1 - f) * glm::dvec3(0, 0, 1);
    if (length < 0.01) continue;
    ASSERT_NEAR(glm::length(glm::cross(glm::normalize(axis), sums.direction / length)), 0, 0.01)
        << aperture << ' ' << b;
    ASSERT_GT(glm::dot(axis, sums.direction), 0);
  }
}

TEST(Cone, BlendLeavesAnUncutConeAndTurnsACutOneTowardsTheNormal) {
  EXPECT_NEAR(clip_blend(0.01, std::cos(0.5)), 1, 1e-5);
  EXPECT_LT(clip_blend(0.2, std::cos(pi / 2)), 0.95);
  EXPECT_GE(clip_blend(0.2, std::cos(2.2)), 0);
}

TEST(Cone, OverlapIsTheQuadrature) {
  for (int i = 0; i < 400; ++i) {
    Random random(4, stream_of("overlap"), static_cast<std::uint64_t>(i));
    const double first = random.uniform(0.001, 0.9), second = random.uniform(0.001, 0.9), b = random.uniform(0, pi);
    const double truth = reference::overlap_of_cones(first, second, b, 20000);
    ASSERT_NEAR(overlap_of_apertures(first, second, std::cos(b)), truth, 1e-4) << first << ' ' << second << ' ' << b;
    ASSERT_NEAR(overlap_of_apertures(second, first, std::cos(b)), truth, 1e-4) << first << ' ' << second << ' ' << b;
    const double together = merge_apertures(first, second, std::cos(b));
    ASSERT_GE(together, std::max(first, second) - 1e-6);
    ASSERT_LE(together, std::min(first + second, 1.0) + 1e-6);
  }
}

TEST(Cone, OverlapOfConesWithinAndApart) {
  EXPECT_DOUBLE_EQ(overlap_of_apertures(0.3, 0.1, 1), 0.1);
  EXPECT_DOUBLE_EQ(overlap_of_apertures(0.01, 0.01, -1), 0);
  EXPECT_NEAR(overlap_of_apertures(0.9, 0.9, -1), 0.8, 1e-12);
  EXPECT_DOUBLE_EQ(merge_apertures(0, 0.2, 0.3), 0.2);
}

TEST(Cone, SpreadConeKeepsShareAndMeanDirection) {
  for (const double share : {0.001, 0.05, 0.4, 0.9})
    for (const double concentration : {0.3, 0.9, 1.0}) {
      // As concentrated as an opaque cone, or less.
      const double length = concentration * share * (1 - share);
      const Cone cone = spread_cone({share, 0, length * 0.6, length * 0.8});
      EXPECT_NEAR(cone.aperture * cone.opacity, share, 1e-9);
      EXPECT_NEAR(cone.opacity * cone.aperture * (1 - cone.aperture), length, 1e-9);
      EXPECT_NEAR(cone.z, 0.8, 1e-9);
      if (concentration == 1.0) {
        EXPECT_NEAR(cone.opacity, 1, 1e-9);
      }
    }
  const Cone none = spread_cone({0, 0, 0, 0});
  EXPECT_NEAR(none.aperture * none.opacity, 0, 1e-8);
}

}  // namespace
}  // namespace understory
