#include "host/passes/check_fragments.hpp"

namespace understory {

CheckFragmentsPass::CheckFragmentsPass(Device& device, int lanes)
    : lanes_(device, lanes, "check-fragments"),
      kernel_(device, "check_fragments", "check_fragments", "check-fragments", lanes_.option()) {}

void CheckFragmentsPass::run(const FragmentPlanes& planes) {
  require_planes("check-fragments", planes, planes.position_x);
  const std::uint32_t items = lanes_.items(planes);
  kernel_.launch(items, lanes_.local_size(), planes.position_x, planes.position_y, planes.position_z, planes.normal_x,
                 planes.normal_y, planes.normal_z, items, planes.validity);
}

}  // namespace understory
