#include "host/passes/ellipsoid_cap.hpp"

namespace understory {

EllipsoidCapPass::EllipsoidCapPass(Device& device, int lanes)
    : lanes_(device, lanes, "ellipsoid-cap"),
      kernel_(device, "ellipsoid_cap", "shade_ellipsoid_cap", "ellipsoid-cap", lanes_.option()) {}

void EllipsoidCapPass::run(const FragmentPlanes& planes, const OwnerTables& owners, const Buffer<CrownRecord>& crowns,
                           Buffer<float>& visibility) {
  require_planes("ellipsoid-cap", planes, visibility);
  require_some("ellipsoid-cap", "crowns", crowns.size());
  const std::uint32_t items = lanes_.items(planes);
  kernel_.launch(items, lanes_.local_size(), planes.position_x, planes.position_y, planes.position_z, planes.normal_x,
                 planes.normal_y, planes.normal_z, planes.owner, owners.crown, owners.rows(), crowns, row_count(crowns),
                 items, visibility, planes.validity);
}

}  // namespace understory
