#include "host/passes/screen_rays.hpp"

#include <cmath>
#include <string>

#include "sim/error.hpp"

namespace understory {
namespace {

void require(bool holds, const std::string& what) {
  if (!holds) throw Error(ErrorKind::invalid_input, "screen-rays: " + what);
}

std::uint32_t ray_count(const NearField& near_field, int rays) {
  require(rays >= 1 && rays <= 64, std::to_string(rays) + " rays; allowed: 1 to 64");
  require(near_field.normals != "none", "normals none; allowed: buffer, depth");
  require(near_field.falloff == "constant", "falloff " + near_field.falloff + "; allowed: constant");
  require(near_field.second_radius == 0, "a second radius; allowed: one");
  require(std::isfinite(near_field.thickness) && near_field.thickness > 0,
          "thickness " + std::to_string(near_field.thickness) + "; allowed: a number above 0");
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
