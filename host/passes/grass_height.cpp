#include "host/passes/grass_height.hpp"

namespace understory {

GrassHeightPass::GrassHeightPass(Device& device, int lanes)
    : lanes_(device, lanes, "grass-height"),
      kernel_(device, "grass_height", "shade_grass_height", "grass-height", lanes_.option()) {}

void GrassHeightPass::run(const FragmentPlanes& planes, const OwnerTables& owners, Buffer<float>& visibility) {
  require_planes("grass-height", planes, visibility);
  require_size("grass-height", "height_above_root", planes.height_above_root.size(), planes.padded_fragments);
  require_size("grass-height", "blade_length", planes.blade_length.size(), planes.padded_fragments);
  const std::uint32_t items = lanes_.items(planes);
  const auto blade = static_cast<std::uint32_t>(SurfaceClass::blade);
  kernel_.launch(items, lanes_.local_size(), planes.height_above_root, planes.blade_length, planes.owner,
                 owners.surface_class, owners.rows(), blade, items, visibility, planes.validity);
}

}  // namespace understory
