// A pose's crowns and occluder spheres as the records that visibility kernels read.
#pragma once
#include <string>
#include <vector>

#include "kernels/shared/records.h"
#include "kernels/shared/transmittance_shell.h"
#include "sim/pose.hpp"

namespace understory {

/// One row per Pose::crowns. `tree_method` decides whose constant of eq. 6 is taken, the sphere's or the ellipsoid's.
std::vector<CrownRecord> crown_records(const Pose& pose, const std::string& tree_method);

/// Shells of all crowns: those of Pose::crowns[i] are shells[first[i]] up to shells[first[i + 1]].
template <typename Shell>
struct ShellRows {
  std::vector<std::uint32_t> first;
  std::vector<Shell> shells;
};

/// Of each crown the sphere around all of it, then the clustered ones: what shells-cap reads, or with `levels`
/// shells-cap-levels.
ShellRows<CrownRecord> cap_shells(const Pose& pose, bool levels);

/// Of each species the fits of its crown's shells at rest, at scale 1 (World::crown_models: shape, k, near share);
/// none for a species without a crown.
std::vector<std::vector<TransmittanceShell>> fit_species(const World& world);

/// These fits where the crowns are.
ShellRows<TransmittanceShell> transmittance_shells(const Pose& pose,
                                                   const std::vector<std::vector<TransmittanceShell>>& fits);

/// The spheres that shade: of crowns, with the share of light that their foliage blocks, and of occluders, opaque.
/// `clustered`: the spheres around each crown's clusters of foliage instead of the one around it.
std::vector<ShadingSphere> shading_spheres(const Pose& pose, bool crowns, bool occluders, bool clustered = false);

}  // namespace understory
