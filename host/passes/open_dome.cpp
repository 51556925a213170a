#include "host/passes/open_dome.hpp"

namespace understory {

OpenDomePass::OpenDomePass(Device& device, int lanes)
    : lanes_(device, lanes, "open-dome"),
      kernel_(device, "open_dome", "shade_open_dome", "open-dome", lanes_.option()) {}

void OpenDomePass::run(const FragmentPlanes& planes, Buffer<float>& visibility) {
  require_planes("open-dome", planes, visibility);
  const std::uint32_t items = lanes_.items(planes);
  kernel_.launch(items, lanes_.local_size(), planes.normal_z, items, visibility);
}

}  // namespace understory
