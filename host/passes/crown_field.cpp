#include "host/passes/crown_field.hpp"

namespace understory {

CrownFieldPass::CrownFieldPass(Device& device, int lanes)
    : lanes_(device, lanes, "crown-field"),
      kernel_(device, "crown_field", "shade_crown_field", "crown-field", lanes_.option()) {}

void CrownFieldPass::run(const FragmentPlanes& planes, const CrownFieldTables& fields, Buffer<float>& visibility) {
  require_planes("crown-field", planes, visibility);
  for (const auto* group : {&planes.rest_position, &planes.rest_normal})
    for (const Buffer<float>& plane : *group)
      require_size("crown-field", "rest point", plane.size(), planes.padded_fragments);
  require_some("crown-field", "owner_field", fields.owner_field.size());
  require_some("crown-field", "grids", fields.grids.size());
  require_some("crown-field", "cells", fields.cells.size());
  const std::uint32_t items = lanes_.items(planes);
  const auto& p = planes.rest_position;
  const auto& n = planes.rest_normal;
  kernel_.launch(items, lanes_.local_size(), p[0], p[1], p[2], n[0], n[1], n[2], planes.owner, fields.owner_field,
                 row_count(fields.owner_field), fields.grids, row_count(fields.grids), fields.cells, items, visibility,
                 planes.validity);
}

}  // namespace understory
