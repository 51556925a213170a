#include "host/passes/obscurance_area.hpp"

#include "sim/error.hpp"

namespace understory {
namespace {

std::string area_options(const NearField& near_field, double spread) {
  if (near_field.falloff != "constant")
    throw Error(ErrorKind::invalid_input, "obscurance-area: falloff '" + near_field.falloff +
                                              "'; allowed: constant, the only one of section 4.2");
  return obscurance_options(near_field) + " -DSPREAD=" + std::to_string(spread) + "f";
}

}  // namespace

ObscuranceAreaPass::ObscuranceAreaPass(Device& device, const NearField& near_field, const ObscuranceSampleSet& set,
                                       double spread, int lanes)
    : lanes_(device, lanes, "obscurance-area"),
      near_field_(near_field),
      rows_(device, std::span<const ObscuranceRow>(line_rows(set, near_field)), "obscurance areas"),
      kernel_(device, "obscurance_area", "shade_obscurance_area", "obscurance-area",
              lanes_.option() + area_options(near_field, spread)) {}

void ObscuranceAreaPass::run(FragmentPlanes& planes, const ObscuranceView& view, const DepthMoments& moments,
                             Buffer<float>& visibility) {
  require_view("obscurance-area", planes, view, visibility);
  const ObscuranceSetting setting = obscurance_setting(view, near_field_);
  const std::uint32_t items = lanes_.items(planes);
  kernel_.launch(items, lanes_.local_size(), planes.depth, planes.normal_x, planes.normal_y, planes.normal_z, setting,
                 moments.mean, moments.variance, moments.coverage, moments.level_table,
                 static_cast<std::int32_t>(moments.levels.size()), rows_, row_count(rows_), items, visibility,
                 planes.validity);
}

}  // namespace understory
