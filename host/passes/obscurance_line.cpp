#include "host/passes/obscurance_line.hpp"

namespace understory {

ObscuranceLinePass::ObscuranceLinePass(Device& device, const NearField& near_field, const ObscuranceSampleSet& set,
                                       int lanes)
    : lanes_(device, lanes, "obscurance-line"),
      near_field_(near_field),
      rows_(device, std::span<const ObscuranceRow>(line_rows(set, near_field)), "obscurance lines"),
      kernel_(device, "obscurance_line", "shade_obscurance_line", "obscurance-line",
              lanes_.option() + obscurance_options(near_field)) {}

void ObscuranceLinePass::run(FragmentPlanes& planes, const ObscuranceView& view, Buffer<float>& visibility) {
  require_view("obscurance-line", planes, view, visibility);
  const ObscuranceSetting setting = obscurance_setting(view, near_field_);
  const std::uint32_t items = lanes_.items(planes);
  kernel_.launch(items, lanes_.local_size(), planes.depth, planes.normal_x, planes.normal_y, planes.normal_z, setting,
                 rows_, row_count(rows_), items, visibility, planes.validity);
}

}  // namespace understory
