// The three blocked shares of a sphere, in double: closed forms, quadrature over rings, and counted rays.
#include "kernels/shared/solid_angle.h"

#include <gtest/gtest.h>

#include "tests/reference/solid_angle.hpp"
#include "tests/support/fragments.hpp"
#include "tests/support/tolerances.hpp"

namespace understory {
namespace {

using reference::Weighting;
const double pi = std::numbers::pi;
const glm::dvec3 up(0, 0, 1);

double cosine_share(glm::dvec3 c, glm::dvec3 n, double r) {
  return solid_angle_cosine(c.x, c.y, c.z, n.x, n.y, n.z, r);
}
double exact_share(glm::dvec3 c, glm::dvec3 n, double r) { return solid_angle_exact(c.x, c.y, c.z, n.x, n.y, n.z, r); }
double paper_share(glm::dvec3 c, glm::dvec3 n, double r) { return solid_angle(c.x, c.y, c.z, n.x, n.y, n.z, r); }

/// Share of a million directions of the hemisphere of `up` that hit the sphere.
double counted_share(glm::dvec3 c, double r, Weighting weighting) {
  constexpr int side = 1000;
  int hits = 0;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const double share = (i + 0.5) / side, turn = 2 * pi * (j + 0.5) / side;
      const double z = weighting == Weighting::cosine ? std::sqrt(1 - share) : share;
      const double flat = std::sqrt(1 - z * z);
      const double along = glm::dot(c, glm::dvec3(flat * std::cos(turn), flat * std::sin(turn), z));
      if (along > 0 && glm::dot(c, c) - along * along < r * r) ++hits;
    }
  return hits / double(side * side);
}

TEST(SolidAngle, ClosedForms) {
  // Overhead: (r/d)^2 cosine-weighted, 1 - sqrt(1 - (r/d)^2) uniform; tilted but above the plane: times the cosine.
  for (const double d : {1.0, 1.5, 2.0, 3.0, 50.0, 1e6}) {
    EXPECT_NEAR(cosine_share({0, 0, d}, up, 1), 1 / (d * d), tolerance::solid_angle) << d;
    EXPECT_NEAR(exact_share({0, 0, d}, up, 1), 1 - std::sqrt(1 - 1 / (d * d)), tolerance::solid_angle) << d;
    EXPECT_NEAR(paper_share({0, 0, d}, up, 1), 1 / (2 * d * d), tolerance::solid_angle) << d;
    // Below the plane nothing is blocked, but for the paper's form.
    EXPECT_EQ(cosine_share({0, 0, -d}, up, 1), 0) << d;
    EXPECT_EQ(exact_share({0, 0, -d}, up, 1), 0) << d;
    // On the horizon: half the cone's solid angle.
    EXPECT_NEAR(exact_share({d, 0, 0}, up, 1), (1 - std::sqrt(1 - 1 / (d * d))) / 2, tolerance::solid_angle) << d;
  }
  EXPECT_NEAR(cosine_share({0, 3, 4}, up, 2), 0.8 * 4 / 25, tolerance::solid_angle);
  // Touching a sphere at an angle b to the normal: (1 + cos b)/2 and 1 - b/pi, as for a half-space.
  for (const double b : {0.0, 0.5, pi / 2, 2.0, pi}) {
    EXPECT_NEAR(cosine_share({std::sin(b), 0, std::cos(b)}, up, 1), (1 + std::cos(b)) / 2, 1e-5) << b;
    EXPECT_NEAR(exact_share({std::sin(b), 0, std::cos(b)}, up, 1), 1 - b / pi, 1e-5) << b;
  }
  // The centre is dark, a sphere of no size is not there.
  EXPECT_NEAR(cosine_share({0, 0, 0}, up, 1), 1, 1e-9);
  EXPECT_NEAR(exact_share({0, 0, 0}, up, 1), 1, 1e-9);
  EXPECT_EQ(paper_share({0, 0, 0}, up, 1), 1);
  EXPECT_NEAR(cosine_share({0, 0, 1}, up, 1e-12), 0, 1e-20);
}

TEST(SolidAngle, QuadratureIsCountedRays) {
  for (const glm::dvec3 c : {glm::dvec3(0, 0, 2), glm::dvec3(2, 0, 0.5), glm::dvec3(1, 1, -0.3), glm::dvec3(0, 1.2, 0)})
    for (const Weighting weighting : {Weighting::uniform, Weighting::cosine})
      EXPECT_NEAR(reference::blocked_share(c, up, 1, weighting), counted_share(c, 1, weighting),
                  tolerance::ray_counting);
}

TEST(SolidAngle, SharedFormsAreTheQuadrature) {
  for (int i = 0; i < 3000; ++i) {
    Random random(6, stream_of("sphere share"), static_cast<std::uint64_t>(i));
    const glm::dvec3 n = glm::normalize(glm::dvec3(random_direction(random)));
    const double r = std::exp(random.uniform(-4, 4)), d = r * std::exp(random.uniform(-1, 3));
    // Every other sphere crosses the horizon.
    const glm::dvec3 any = glm::normalize(glm::dvec3(random_direction(random)));
    const glm::dvec3 level = glm::normalize(any - glm::dot(any, n) * n) * d + n * r * random.uniform(-1, 1);
    const glm::dvec3 c = i % 2 ? any * d : level;
    const double q = tolerance::quadrature + tolerance::solid_angle;
    ASSERT_NEAR(cosine_share(c, n, r), reference::blocked_share(c, n, r, Weighting::cosine), q) << d / r;
    ASSERT_NEAR(exact_share(c, n, r), reference::blocked_share(c, n, r, Weighting::uniform), q) << d / r;
    ASSERT_NEAR(paper_share(c, n, r), reference::paper_share(c, r), tolerance::solid_angle);
  }
}

TEST(SolidAngle, IsContinuousWhereTheSphereCrossesThePlaneTheFitEndsAndTheInsideBegins) {
  const double step = 1e-7;
  for (const double d : {0.5, 1.0, 1.3, 1.5, 2.0, 4.0, 9.0}) {
    for (int i = -120; i <= 120; ++i) {
      const double s = std::clamp(i / 100.0, -d, d);
      const auto centre = [&](double height, double distance) {
        return glm::dvec3(std::sqrt(std::max(distance * distance - height * height, 0.0)), 0, height);
      };
      const glm::dvec3 here = centre(s, d), farther = centre(s, d + step), higher = centre(std::min(s + step, d), d);
      // Uniform shares begin like a square root of the height, all leave contact like one of the distance.
      for (const auto share : {cosine_share, exact_share, paper_share}) {
        EXPECT_NEAR(share(here, up, 1), share(farther, up, 1), 1e-3) << s << ' ' << d;
        EXPECT_NEAR(share(here, up, 1), share(higher, up, 1), 1e-3) << s << ' ' << d;
      }
      EXPECT_NEAR(cosine_share(here, up, 1), cosine_share(higher, up, 1), tolerance::solid_angle) << s << ' ' << d;
    }
  }
}

TEST(SolidAngle, WhatIsNotANumberBlocksNothing) {
  for (const auto share : {cosine_share, exact_share, paper_share}) {
    EXPECT_EQ(share({NAN, 0, 1}, up, 1), 0);
    EXPECT_EQ(share({INFINITY, 0, 1}, up, 1), 0);
  }
  EXPECT_EQ(cosine_share({0, 0, 2}, glm::dvec3(NAN), 1), 0);
}

}  // namespace
}  // namespace understory
