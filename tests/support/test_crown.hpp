// Crowns and their owners for tests of the tree methods. No test framework (test_fragments.hpp).
#pragma once
#include <glm/gtc/quaternion.hpp>
#include <vector>

#include "kernels/shared/records.h"
#include "tests/support/test_fragments.hpp"

namespace understory {

struct TestCrown {
  glm::dvec3 centre{0};
  double radius = 1;     // of the sphere, m
  glm::dmat3 axes{1};    // of the ellipsoid
  glm::dvec3 radii{1};   // m
  double alpha_rho = 1;  // 1/m^3
  double ambient = 1, extinction = 1;

  CrownRecord record() const {
    CrownRecord r{};
    r.x = r.centre_x = static_cast<float>(centre.x);
    r.y = r.centre_y = static_cast<float>(centre.y);
    r.z = r.centre_z = static_cast<float>(centre.z);
    r.radius = static_cast<float>(radius);
    r.alpha_rho = static_cast<float>(alpha_rho);
    for (int axis = 0; axis < 3; ++axis) {
      for (int k = 0; k < 3; ++k) r.to_unit[4 * axis + k] = static_cast<float>(axes[axis][k] / radii[axis]);
      r.to_unit[4 * axis + 3] = static_cast<float>(radii[axis] * radii[axis]);
    }
    r.volume_scale = static_cast<float>(radii.x * radii.y * radii.z);
    r.ambient = static_cast<float>(ambient);
    r.extinction = static_cast<float>(extinction);
    return r;
  }
};

/// Centres and radii that float holds exactly, so that a reference in double sees the same crown.
inline TestCrown random_crown(Random& random) {
  const auto exact = [&](double low, double high) {
    return static_cast<double>(static_cast<float>(random.uniform(low, high)));
  };
  TestCrown crown;
  crown.centre = glm::dvec3(exact(-30, 30), exact(-30, 30), exact(0, 20));
  crown.radius = exact(0.5, 6);
  crown.radii = glm::dvec3(exact(0.5, 4), exact(0.5, 4), exact(0.5, 8));
  crown.axes = glm::dmat3(
      glm::mat3_cast(glm::angleAxis(random.uniform(0, 6), glm::normalize(glm::dvec3(random_direction(random))))));
  crown.alpha_rho = exact(0, 1) / (crown.radius * crown.radius * crown.radius);
  crown.ambient = exact(0.2, 1);
  crown.extinction = exact(0, 2);
  return crown;
}

/// Owners 0 background, then one per crown, then one without a crown.
inline OwnerTables crown_owners(Device& device, std::size_t crowns) {
  std::vector<Owner> owners(crowns + 2);
  for (std::size_t i = 0; i < crowns; ++i) {
    owners[i + 1].surface = SurfaceClass::leaf;
    owners[i + 1].crown = static_cast<std::int32_t>(i);
  }
  owners.back().surface = SurfaceClass::terrain;
  return upload_owners(device, owners);
}

inline Buffer<CrownRecord> upload_crowns(Device& device, const std::vector<TestCrown>& crowns) {
  std::vector<CrownRecord> records;
  for (const TestCrown& crown : crowns) records.push_back(crown.record());
  return Buffer<CrownRecord>(device, std::span<const CrownRecord>(records), "crowns");
}

}  // namespace understory
