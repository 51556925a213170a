// sphere-cap: eq. 4-6 of Hegeman et al. 2006 against counted volume, closed forms, and the device against double.
#include "host/passes/sphere_cap.hpp"

#include <gtest/gtest.h>

#include "kernels/shared/sphere_cap.h"
#include "tests/reference/sphere_cap.hpp"
#include "tests/support/crowns.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/tolerances.hpp"

namespace understory {
namespace {

const double pi = std::numbers::pi;

double shared_form(glm::dvec3 p, glm::dvec3 n, double radius, double alpha_rho) {
  return sphere_cap(p.x, p.y, p.z, n.x, n.y, n.z, radius, alpha_rho);
}

Shaded shade(const std::vector<TestFragment>& fragments, const std::vector<TestCrown>& crowns) {
  return shade_everywhere(fragments, [&](Device& device, int lanes, FragmentPlanes& planes, Buffer<float>& visibility) {
    SphereCapPass(device, lanes)
        .run(planes, crown_owners(device, crowns.size()), upload_crowns(device, crowns), visibility);
  });
}

TEST(SphereCap, VolumeIsThatOfCountedPoints) {
  // A grid of 200^3 points in the sphere's cube.
  const glm::dvec3 n = glm::normalize(glm::dvec3(1, 2, -2)), p(0.3, -0.1, 0.2);
  constexpr int side = 200;
  std::size_t beyond = 0;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      for (int k = 0; k < side; ++k) {
        const glm::dvec3 q = (glm::dvec3(i, j, k) + 0.5) * (2.0 / side) - 1.0;
        if (glm::dot(q, q) < 1 && glm::dot(q - p, n) > 0) ++beyond;
      }
  const double counted = static_cast<double>(beyond) * 8 / (side * side * side);
  const double s = glm::dot(p, n);
  EXPECT_NEAR(reference::cap_volume(1 - s, 1), counted, 2e-3);
  const double offset = glm::length(p - s * n), f = (1 - s) * (1 - s) / ((1 - s) * (1 - s) + offset * offset);
  EXPECT_NEAR(cap_occluders(p.x, p.y, p.z, n.x, n.y, n.z, 1.0), f * counted, 2e-3);
}

TEST(SphereCap, ClosedForms) {
  const glm::dvec3 up(0, 0, 1);
  // The centre looks through half the sphere, its surface inward through all of it, outward through nothing.
  EXPECT_NEAR(shared_form({0, 0, 0}, up, 2, 0.05), std::exp(-0.05 * 2 * pi * 8 / 3), 1e-6);
  EXPECT_NEAR(shared_form({0, 0, -2}, up, 2, 0.05), std::exp(-0.05 * 4 * pi * 8 / 3), 1e-6);
  EXPECT_EQ(shared_form({0, 0, 2}, up, 2, 0.05), 1);
  // Beyond the plane, far away, without leaves, without a radius: open. Impenetrable: dark.
  EXPECT_EQ(shared_form({0, 0, 5}, up, 2, 0.05), 1);
  EXPECT_NEAR(shared_form({1e6, 0, 0}, up, 2, 0.05), 1, 1e-9);
  EXPECT_EQ(shared_form({0.5, 0, 0}, up, 2, 0), 1);
  EXPECT_EQ(shared_form({0, 0, 0}, up, 0, 1), 1);
  EXPECT_LT(shared_form({0, 0, 0}, up, 2, 1e9), 1e-37);
}

TEST(SphereCap, SharedFormIsTheReference) {
  for (int i = 0; i < 100000; ++i) {
    Random random(1, stream_of("sphere cap"), static_cast<std::uint64_t>(i));
    const double radius = std::exp(random.uniform(-5, 5));
    const glm::dvec3 p = glm::dvec3(random_direction(random)) * radius * random.uniform(0, 1.5);
    const glm::dvec3 n = glm::normalize(glm::dvec3(random_direction(random)));
    const double alpha_rho = random.uniform(0, 2) / (radius * radius * radius);
    ASSERT_NEAR(shared_form(p, n, radius, alpha_rho), reference::sphere_cap(p, n, radius, alpha_rho), 1e-6);
  }
}

TEST(SphereCap, DeviceIsTheReference) {
  UNDERSTORY_NEEDS_DEVICE();
  const std::vector<TestCrown> crowns = random_crowns(7);
  for (const std::size_t size : odd_sizes) {
    const std::vector<TestFragment> fragments = crown_fragments(size, crowns);
    const Shaded shaded = shade(fragments, crowns);
    for (std::size_t i = 0; i < size; ++i) {
      const TestFragment& f = fragments[i];
      if (f.owner > crowns.size()) {
        EXPECT_EQ(shaded.visibility[i], 1);
        EXPECT_EQ(shaded.validity[i], 0u);
        continue;
      }
      const TestCrown& crown = crowns[f.owner - 1];
      const glm::dvec3 p = glm::dvec3(f.position) - crown.centre;
      const double exact = reference::sphere_cap(p, glm::dvec3(f.normal), crown.radius,
                                                 static_cast<double>(static_cast<float>(crown.alpha_rho)));
      EXPECT_NEAR(shaded.visibility[i], exact, tolerance::crown) << i;
      const double share = glm::length(p) / crown.radius;
      if (std::abs(share - 1) > 1e-4) {
        EXPECT_EQ(shaded.validity[i], share > 1 ? validity::outside_model : 0u) << share;
      }
    }
  }
}

TEST(SphereCap, RigidMotionAndScaleChangeNothing) {
  UNDERSTORY_NEEDS_DEVICE();
  const std::vector<TestCrown> crowns = random_crowns(3);
  const std::vector<TestFragment> fragments = crown_fragments(333, crowns);
  const glm::dmat3 turn = glm::dmat3(glm::mat3_cast(glm::angleAxis(1.1, glm::normalize(glm::dvec3(3, 1, -2)))));
  std::vector<TestCrown> moved = crowns;
  for (TestCrown& crown : moved) {
    crown.centre = 2.0 * (turn * crown.centre) + glm::dvec3(5, -7, 3);
    crown.radius *= 2;
    crown.alpha_rho /= 8;
  }
  std::vector<TestFragment> moved_fragments = fragments;
  for (TestFragment& f : moved_fragments) {
    f.position = glm::vec3(2.0 * (turn * glm::dvec3(f.position)) + glm::dvec3(5, -7, 3));
    f.normal = glm::vec3(turn * glm::dvec3(f.normal));
  }
  const Shaded here = shade(fragments, crowns), there = shade(moved_fragments, moved);
  for (std::size_t i = 0; i < fragments.size(); ++i)
    EXPECT_NEAR(here.visibility[i], there.visibility[i], tolerance::moved);
}

TEST(SphereCap, DenserFoliageNeverBrightens) {
  UNDERSTORY_NEEDS_DEVICE();
  std::vector<TestCrown> crowns = random_crowns(3);
  const std::vector<TestFragment> fragments = crown_fragments(333, crowns);
  const Shaded thin = shade(fragments, crowns);
  for (TestCrown& crown : crowns) crown.alpha_rho *= 1.5;
  const Shaded dense = shade(fragments, crowns);
  for (std::size_t i = 0; i < fragments.size(); ++i)
    EXPECT_LE(dense.visibility[i], thin.visibility[i] + tolerance::exp_minus);
}

TEST(SphereCap, GarbageStaysWithinBounds) {
  UNDERSTORY_NEEDS_DEVICE();
  std::vector<TestCrown> crowns = random_crowns(6);
  crowns[1].radius = 0;
  crowns[2].radius = INFINITY;
  crowns[3].alpha_rho = NAN;
  crowns[4].centre.x = NAN;
  crowns[5].alpha_rho = -1;
  const std::vector<TestFragment> fragments = garbage(8);
  const Shaded shaded = shade(fragments, crowns);  // expects [0, 1]
  for (std::size_t i = 0; i < fragments.size(); ++i)
    if (std::isnan(fragments[i].position.x)) {
      EXPECT_EQ(shaded.visibility[i], 1);
    }
}

TEST(SphereCap, NamesWhatDoesNotFit) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  const FragmentPlanes planes = allocate_planes(device, 300, 1, false);
  Buffer<float> visibility(device, 300, "visibility");
  const std::vector<TestCrown> crowns = random_crowns(1);
  const std::string message = message_of(ErrorKind::unexpected, [&] {
    SphereCapPass(device).run(planes, crown_owners(device, 1), upload_crowns(device, crowns), visibility);
  });
  EXPECT_NE(message.find("sphere-cap: plane out has 300 elements, 512 are needed"), std::string::npos) << message;
  EXPECT_NE(message_of(ErrorKind::unexpected, [&] { SphereCapPass(device, 3); }).find("3 is not one of"),
            std::string::npos);
}

}  // namespace
}  // namespace understory
