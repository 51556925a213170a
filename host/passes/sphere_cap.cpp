#include "host/passes/sphere_cap.hpp"

namespace understory {

SphereCapPass::SphereCapPass(Device& device, int lanes)
    : lanes_(device, lanes, "sphere-cap"),
      kernel_(device, "sphere_cap", "shade_sphere_cap", "sphere-cap", lanes_.option()) {}

void SphereCapPass::run(const FragmentPlanes& planes, const OwnerTables& owners, const Buffer<CrownRecord>& crowns,
                        Buffer<float>& visibility) {
  require_planes("sphere-cap", planes, visibility);
  require_some("sphere-cap", "crowns", crowns.size());
  const std::uint32_t items = lanes_.items(planes);
  kernel_.launch(items, lanes_.local_size(), planes.position_x, planes.position_y, planes.position_z, planes.normal_x,
                 planes.normal_y, planes.normal_z, planes.owner, owners.crown, owners.rows(), crowns, row_count(crowns),
                 items, visibility, planes.validity);
}

}  // namespace understory
