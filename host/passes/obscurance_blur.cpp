#include "host/passes/obscurance_blur.hpp"

namespace understory {

ObscuranceBlurPass::ObscuranceBlurPass(Device& device, int lanes)
    : lanes_(device, lanes, "obscurance-blur"),
      kernel_(device, "obscurance_blur", "blur_obscurance", "obscurance-blur", lanes_.option()) {}

void ObscuranceBlurPass::run(const FragmentPlanes& planes, const ObscuranceView& view, int radius, double reach,
                             Buffer<float>& visibility, Buffer<float>& scratch) {
  require_view("obscurance-blur", planes, view, visibility);
  require_size("obscurance-blur", "scratch", scratch.size(), planes.padded_fragments);
  const ObscuranceSetting setting = obscurance_setting(view, NearField{});
  const std::uint32_t items = lanes_.items(planes);
  const auto blur = [&](const Buffer<float>& from, std::int32_t down, Buffer<float>& to) {
    kernel_.launch(items, lanes_.local_size(), from, planes.depth, planes.normal_x, planes.normal_y, planes.normal_z,
                   setting, static_cast<std::int32_t>(radius), down, static_cast<float>(reach), items, planes.validity,
                   to);
  };
  blur(visibility, 0, scratch);
  blur(scratch, 1, visibility);
}

}  // namespace understory
