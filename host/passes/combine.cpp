#include "host/passes/combine.hpp"

namespace understory {

CombinePass::CombinePass(Device& device, int lanes)
    : lanes_(device, lanes, "combine"), kernel_(device, "combine", "combine", "combine", lanes_.option()) {}

void CombinePass::run(const FragmentPlanes& planes, const OwnerTables& owners, const VisibilityTerms& terms,
                      Buffer<float>& visibility) {
  require_planes("combine", planes, visibility);
  // Order of the bits in kernels/combine.cl. A missing term's place is taken by a plane that is not read.
  const Buffer<float>* order[] = {terms.ambient,   terms.tree, terms.grass, terms.crowns,
                                  terms.occluders, terms.dome, terms.near};
  std::uint32_t present = 0;
  for (std::uint32_t bit = 0; bit < std::size(order); ++bit) {
    if (order[bit] == nullptr) {
      order[bit] = &planes.normal_z;
      continue;
    }
    require_size("combine", "term", order[bit]->size(), planes.padded_fragments);
    present |= 1u << bit;
  }
  const std::uint32_t items = lanes_.items(planes);
  kernel_.launch(items, lanes_.local_size(), present, *order[0], *order[1], *order[2], *order[3], *order[4], *order[5],
                 *order[6], static_cast<std::uint32_t>(terms.near_is_limit), terms.horizon_classes, planes.owner,
                 owners.surface_class, owners.rows(), items, planes.validity, visibility);
}

}  // namespace understory
