#include "host/passes/shells_cap.hpp"

#include <algorithm>

namespace understory {

ShellsCapPass::ShellsCapPass(Device& device, bool levels, int lanes)
    : lanes_(device, lanes, levels ? "shells-cap-levels" : "shells-cap"),
      kernel_(device, "shells_cap", "shade_shells_cap", levels ? "shells-cap-levels" : "shells-cap",
              lanes_.option() + (levels ? " -DLEVELS" : "")) {}

void ShellsCapPass::run(const FragmentPlanes& planes, const OwnerTables& owners, const Buffer<std::uint32_t>& first,
                        std::size_t crowns, const Buffer<CrownRecord>& shells, Buffer<float>& visibility) {
  require_planes("shells-cap", planes, visibility);
  require_some("shells-cap", "shells", shells.size());
  require_size("shells-cap", "first shells", std::min(first.size(), crowns + 1), crowns + 1);
  const std::uint32_t items = lanes_.items(planes);
  kernel_.launch(items, lanes_.local_size(), planes.position_x, planes.position_y, planes.position_z, planes.normal_x,
                 planes.normal_y, planes.normal_z, planes.owner, owners.crown, owners.rows(), first,
                 static_cast<std::uint32_t>(crowns), shells, row_count(shells), items, visibility, planes.validity);
}

}  // namespace understory
