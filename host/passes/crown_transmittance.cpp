#include "host/passes/crown_transmittance.hpp"

#include <algorithm>

namespace understory {

CrownTransmittancePass::CrownTransmittancePass(Device& device, bool dome, int lanes)
    : lanes_(device, lanes, "crown-transmittance"),
      kernel_(device, "crown_transmittance", "shade_crown_transmittance", "crown-transmittance",
              lanes_.option() + (dome ? " -DSKY_DOME" : "")) {}

void CrownTransmittancePass::run(const FragmentPlanes& planes, const OwnerTables& owners,
                                 const Buffer<std::uint32_t>& first, std::size_t crowns,
                                 const Buffer<TransmittanceShell>& shells, Buffer<float>& visibility) {
  require_planes("crown-transmittance", planes, visibility);
  require_some("crown-transmittance", "shells", shells.size());
  require_size("crown-transmittance", "first shells", std::min(first.size(), crowns + 1), crowns + 1);
  const std::uint32_t items = lanes_.items(planes);
  kernel_.launch(items, lanes_.local_size(), planes.position_x, planes.position_y, planes.position_z, planes.normal_x,
                 planes.normal_y, planes.normal_z, planes.owner, owners.crown, owners.rows(), first,
                 static_cast<std::uint32_t>(crowns), shells, row_count(shells), items, visibility, planes.validity);
}

}  // namespace understory
