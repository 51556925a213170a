#include "host/passes/screen_rays.hpp"

#include "sim/error.hpp"

namespace understory {
namespace {

std::uint32_t ray_count(const NearField& near_field, int rays) {
  if (rays < 1 || rays > 64)
    throw Error(ErrorKind::invalid_input, "screen-rays: " + std::to_string(rays) + " rays; allowed: 1 to 64");
  if (near_field.normals == "none")
    throw Error(ErrorKind::invalid_input, "screen-rays: normals none; allowed: buffer, depth");
  return static_cast<std::uint32_t>(rays);
}

}  // namespace

ScreenRaysPass::ScreenRaysPass(Device& device, const NearField& near_field, int rays, int lanes)
    : lanes_(device, lanes, "screen-rays"),
      near_field_(near_field),
      rays_(ray_count(near_field, rays)),
      kernel_(device, "screen_rays", "shade_screen_rays", "screen-rays", lanes_.option()) {}

void ScreenRaysPass::run(FragmentPlanes& planes, const ObscuranceView& view, Buffer<float>& visibility) {
  require_view("screen-rays", planes, view, visibility);
  const ObscuranceSetting setting = obscurance_setting(view, near_field_);
  const std::uint32_t items = lanes_.items(planes);
  kernel_.launch(items, lanes_.local_size(), planes.depth, planes.normal_x, planes.normal_y, planes.normal_z, setting,
                 rays_, items, visibility, planes.validity);
}

}  // namespace understory
