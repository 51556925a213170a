#include "host/passes/reeves_blau.hpp"

namespace understory {

ReevesBlauPass::ReevesBlauPass(Device& device, int lanes)
    : lanes_(device, lanes, "reeves-blau"),
      kernel_(device, "reeves_blau", "shade_reeves_blau", "reeves-blau", lanes_.option()) {}

void ReevesBlauPass::run(const FragmentPlanes& planes, const OwnerTables& owners, const Buffer<CrownRecord>& crowns,
                         Buffer<float>& visibility) {
  require_planes("reeves-blau", planes, visibility);
  require_some("reeves-blau", "crowns", crowns.size());
  const std::uint32_t items = lanes_.items(planes);
  kernel_.launch(items, lanes_.local_size(), planes.position_x, planes.position_y, planes.position_z, planes.owner,
                 owners.crown, owners.rows(), crowns, row_count(crowns), items, visibility, planes.validity);
}

}  // namespace understory
