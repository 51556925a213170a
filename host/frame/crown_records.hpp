// A pose's crowns and occluder spheres as the records that visibility kernels read.
#pragma once
#include <string>
#include <vector>

#include "kernels/shared/records.h"
#include "sim/pose.hpp"

namespace understory {

/// One row per Pose::crowns. `tree_method` decides whose constant of eq. 6 is taken, the sphere's or the ellipsoid's.
std::vector<CrownRecord> crown_records(const Pose& pose, const std::string& tree_method);

/// The spheres that shade: of crowns, with the share of light that their foliage blocks, and of occluders, opaque.
std::vector<ShadingSphere> shading_spheres(const Pose& pose, bool crowns, bool occluders);

}  // namespace understory
