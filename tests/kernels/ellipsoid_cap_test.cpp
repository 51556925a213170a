// ellipsoid-cap: against the sphere, against an independent transform of the plane, and the device against double.
#include "host/passes/ellipsoid_cap.hpp"

#include <gtest/gtest.h>

#include "kernels/shared/ellipsoid_cap.h"
#include "tests/reference/ellipsoid_cap.hpp"
#include "tests/support/crowns.hpp"
#include "tests/support/tolerances.hpp"

namespace understory {
namespace {

double shared_form(glm::dvec3 p, glm::dvec3 n, const glm::dmat3& axes, glm::dvec3 radii, double alpha_rho) {
  const auto row = [&](int i) { return Direction{axes[i].x / radii[i], axes[i].y / radii[i], axes[i].z / radii[i]}; };
  const Direction unit = to_unit_sphere({p.x, p.y, p.z}, row(0), row(1), row(2));
  const glm::dvec3 squares = radii * radii;
  return ellipsoid_cap(unit, {n.x, n.y, n.z}, row(0), row(1), row(2), {squares.x, squares.y, squares.z},
                       radii.x * radii.y * radii.z, alpha_rho);
}

Shaded shade(const std::vector<TestFragment>& fragments, const std::vector<TestCrown>& crowns) {
  return shade_everywhere(fragments, [&](Device& device, int lanes, FragmentPlanes& planes, Buffer<float>& visibility) {
    EllipsoidCapPass(device, lanes)
        .run(planes, crown_owners(device, crowns.size()), upload_crowns(device, crowns), visibility);
  });
}

TEST(EllipsoidCap, EqualRadiiAreASphere) {
  for (int i = 0; i < 1000; ++i) {
    Random random(2, stream_of("sphere"), static_cast<std::uint64_t>(i));
    const TestCrown crown = random_crown(random);
    const glm::dvec3 n = glm::normalize(glm::dvec3(random_direction(random)));
    const glm::dvec3 p = glm::dvec3(random_direction(random)) * crown.radius * random.uniform();
    EXPECT_NEAR(shared_form(p, n, crown.axes, glm::dvec3(crown.radius), crown.alpha_rho),
                reference::sphere_cap(p, n, crown.radius, crown.alpha_rho), 1e-6);
  }
}

TEST(EllipsoidCap, SharedFormIsTheReference) {
  for (int i = 0; i < 20000; ++i) {
    Random random(3, stream_of("ellipsoid"), static_cast<std::uint64_t>(i));
    const TestCrown crown = random_crown(random);
    const glm::dvec3 n = glm::normalize(glm::dvec3(random_direction(random)));
    const glm::dvec3 p = crown.axes * (glm::dvec3(random_direction(random)) * crown.radii * random.uniform(0, 1.2));
    ASSERT_NEAR(shared_form(p, n, crown.axes, crown.radii, crown.alpha_rho),
                reference::ellipsoid_cap(p, n, crown.axes, crown.radii, crown.alpha_rho), 1e-6);
  }
}

TEST(EllipsoidCap, DeviceIsTheReference) {
  UNDERSTORY_NEEDS_DEVICE();
  const std::vector<TestCrown> crowns = random_crowns(7);
  for (const std::size_t size : odd_sizes) {
    const std::vector<TestFragment> fragments = crown_fragments(size, crowns);
    const Shaded shaded = shade(fragments, crowns);
    for (std::size_t i = 0; i < size; ++i) {
      const TestFragment& f = fragments[i];
      if (f.owner > crowns.size()) {
        EXPECT_EQ(shaded.visibility[i], 1);
        continue;
      }
      const TestCrown& crown = crowns[f.owner - 1];
      const glm::dvec3 p = glm::dvec3(f.position) - crown.centre;
      const double exact = reference::ellipsoid_cap(p, glm::dvec3(f.normal), crown.axes, crown.radii, crown.alpha_rho);
      EXPECT_NEAR(shaded.visibility[i], exact, tolerance::ellipsoid_crown) << i;
      const double share = glm::length((glm::transpose(crown.axes) * p) / crown.radii);
      if (std::abs(share - 1) > 1e-4) {
        EXPECT_EQ(shaded.validity[i], share > 1 ? validity::outside_model : 0u) << share;
      }
    }
  }
}

TEST(EllipsoidCap, GarbageStaysWithinBounds) {
  UNDERSTORY_NEEDS_DEVICE();
  std::vector<TestCrown> crowns = random_crowns(4);
  crowns[1].radii.x = 0;
  crowns[2].radii = glm::dvec3(NAN);
  crowns[3].radii.z = 1e30;
  shade(garbage(6), crowns);  // expects [0, 1]
}

}  // namespace
}  // namespace understory
