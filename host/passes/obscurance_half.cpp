#include "host/passes/obscurance_half.hpp"

namespace understory {

ObscuranceView half_view(const ObscuranceView& view) {
  ObscuranceView half = view;
  half.width = (view.width + 1) / 2;
  half.height = (view.height + 1) / 2;
  half.focal = 0.5 * view.focal;
  // The centre of pixel x is 2x + 1/2 in the large image and x + 1/2 in the small one.
  half.centre_x = 0.5 * view.centre_x + 0.25;
  half.centre_y = 0.5 * view.centre_y + 0.25;
  return half;
}

ObscuranceHalfPass::ObscuranceHalfPass(Device& device)
    : kernel_(device, "obscurance_half", "halve_planes", "obscurance-half") {}

void ObscuranceHalfPass::run(const FragmentPlanes& planes, const ObscuranceView& view, FragmentPlanes& half) {
  const ObscuranceView small = half_view(view);
  require_view("obscurance-half", planes, view, planes.depth);
  require_view("obscurance-half", half, small, half.depth);
  kernel_.launch(half.padded_fragments, 0, planes.depth, planes.normal_x, planes.normal_y, planes.normal_z,
                 planes.validity, static_cast<std::uint32_t>(view.width), static_cast<std::uint32_t>(small.width),
                 static_cast<std::uint32_t>(half.fragments), static_cast<std::uint32_t>(half.padded_fragments),
                 half.depth, half.normal_x, half.normal_y, half.normal_z, half.validity);
}

ObscuranceUpsamplePass::ObscuranceUpsamplePass(Device& device, int lanes)
    : lanes_(device, lanes, "obscurance-upsample"),
      kernel_(device, "obscurance_upsample", "upsample_obscurance", "obscurance-upsample", lanes_.option()) {}

void ObscuranceUpsamplePass::run(const FragmentPlanes& half, const Buffer<float>& half_visibility, double reach,
                                 FragmentPlanes& planes, const ObscuranceView& view, Buffer<float>& visibility) {
  const ObscuranceView small = half_view(view);
  require_view("obscurance-upsample", planes, view, visibility);
  require_view("obscurance-upsample", half, small, half_visibility);
  const std::uint32_t items = lanes_.items(planes);
  kernel_.launch(items, lanes_.local_size(), half_visibility, half.depth, half.normal_x, half.normal_y, half.normal_z,
                 half.validity, static_cast<std::int32_t>(small.width), static_cast<std::int32_t>(small.height),
                 planes.depth, planes.normal_x, planes.normal_y, planes.normal_z, obscurance_setting(view, NearField{}),
                 static_cast<float>(reach), items, visibility, planes.validity);
}

}  // namespace understory
