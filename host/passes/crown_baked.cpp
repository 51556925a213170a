#include "host/passes/crown_baked.hpp"

namespace understory {

CrownBakedPass::CrownBakedPass(Device& device, int lanes)
    : lanes_(device, lanes, "crown-baked"),
      kernel_(device, "crown_baked", "shade_crown_baked", "crown-baked", lanes_.option()) {}

void CrownBakedPass::run(const FragmentPlanes& planes, const Buffer<std::uint32_t>& texels, Buffer<float>& visibility) {
  require_planes("crown-baked", planes, visibility);
  require_size("crown-baked", "texel", planes.texel.size(), planes.padded_fragments);
  require_size("crown-baked", "texel_place", planes.texel_place.size(), planes.padded_fragments);
  require_some("crown-baked", "texels", texels.size());
  const std::uint32_t items = lanes_.items(planes);
  kernel_.launch(items, lanes_.local_size(), planes.texel, planes.texel_place, texels, row_count(texels), items,
                 visibility);
}

}  // namespace understory
