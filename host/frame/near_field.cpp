#include "host/frame/near_field.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include "host/passes/normals_from_depth.hpp"
#include "host/passes/obscurance_area.hpp"
#include "host/passes/obscurance_blur.hpp"
#include "host/passes/obscurance_half.hpp"
#include "host/passes/obscurance_line.hpp"
#include "host/passes/obscurance_point.hpp"
#include "host/passes/screen_rays.hpp"
#include "sim/error.hpp"

namespace understory {
namespace {

/// Of the radius: as far from a fragment's plane another surface begins.
constexpr double reach_of_radius = 0.2;

/// What a frame takes of surfaces whose thickness nobody told. Of meadow and plants 3 to 8 radii err about the same, an
/// endless thickness up to twice as much (bench/obscurance.md).
constexpr double usual_thickness = 5;  // radii

/// For rays, which take surfaces to be at least so deep: less errs towards light, more towards dark (likewise).
constexpr double usual_ray_thickness = 0.05;  // m
constexpr double usual_ray_share = 0.1;       // of the ray

NearField with_thickness(const Methods& methods) {
  NearField near_field = methods.near_field;
  if (near_field.thickness != 0) return near_field;
  near_field.thickness = methods.near == "screen-rays"
                             ? std::min(usual_ray_thickness, usual_ray_share * near_field.radius)
                             : usual_thickness * near_field.radius;
  return near_field;
}

/// Area samples with the moments that they read, of planes of one size.
struct AreaSampling {
  AreaSampling(Device& the_device, const Methods& methods)
      : device(&the_device),
        gather(the_device),
        shade(the_device, with_thickness(methods), line_samples(near_samples(methods))) {}
  void run(FragmentPlanes& planes, const ObscuranceView& view, Buffer<float>& visibility) {
    if (moments.levels.empty()) moments = gather.allocate(*device, view);
    gather.run(planes, view, moments);
    shade.run(planes, view, moments, visibility);
  }
  Device* device;
  DepthMomentsPass gather;
  ObscuranceAreaPass shade;
  DepthMoments moments;
};

using ObscurancePass = std::variant<ObscuranceLinePass, ObscurancePointPass, AreaSampling, ScreenRaysPass>;

ObscurancePass obscurance_pass(Device& device, const Methods& methods) {
  const int samples = near_samples(methods);
  const NearField near_field = with_thickness(methods);
  if (methods.near == "obscurance-area") return ObscurancePass(std::in_place_type<AreaSampling>, device, methods);
  if (methods.near == "obscurance-point")
    return ObscurancePass(std::in_place_type<ObscurancePointPass>, device, near_field, point_samples(samples));
  if (methods.near == "screen-rays")
    return ObscurancePass(std::in_place_type<ScreenRaysPass>, device, near_field, samples);
  return ObscurancePass(std::in_place_type<ObscuranceLinePass>, device, near_field, line_samples(samples));
}

/// Normals made from depth, and the planes that they stand in for while obscurance runs.
struct OwnNormals {
  OwnNormals(Device& device, std::size_t padded)
      : pass(device), x(device, padded, "normal_x"), y(device, padded, "normal_y"), z(device, padded, "normal_z") {}
  void swap_with(FragmentPlanes& planes) {
    std::swap(planes.normal_x, x);
    std::swap(planes.normal_y, y);
    std::swap(planes.normal_z, z);
  }
  NormalsFromDepthPass pass;
  Buffer<float> x, y, z;
};

struct HalfResolution {
  HalfResolution(Device& device, std::size_t width, std::size_t height)
      : halve(device),
        upsample(device),
        planes(allocate_planes(device, (width + 1) / 2, (height + 1) / 2, false)),
        visibility(device, planes.padded_fragments, "half visibility") {}
  ObscuranceHalfPass halve;
  ObscuranceUpsamplePass upsample;
  FragmentPlanes planes;
  Buffer<float> visibility;
};

glm::vec3 axis_of(const float (&axis)[4]) { return {axis[0], axis[1], axis[2]}; }

}  // namespace

int near_samples(const Methods& methods) {
  if (methods.near_field.samples > 0) return methods.near_field.samples;
  if (methods.near == "screen-rays") return 16;
  return methods.near == "obscurance-point" ? 12 : methods.near == "obscurance-area" ? 1 : 5;
}

void plan_near_field(const Methods& methods, Plan& plan) {
  if (methods.near == "none") return plan.left_out.push_back({"the near field", "methods.near: none", "methods.near"});
  const NearField& near_field = methods.near_field;
  if (near_field.normals == "depth")
    plan.passes.push_back(
        {"normals-from-depth", "normals_from_depth", "normals made from depth", "methods.near_field.normals"});
  if (near_field.half_resolution)
    plan.passes.push_back(
        {"obscurance-half", "obscurance_half", "half resolution", "methods.near_field.half_resolution"});
  if (methods.near == "obscurance-area")
    plan.passes.push_back(
        {"depth-moments", "depth_moments", "moments of depth that area samples read", "methods.near"});
  std::string program = methods.near;
  program.replace(program.find('-'), 1, "_");
  plan.passes.push_back({methods.near, program, "asked for", "methods.near"});
  if (near_field.blur > 0)
    plan.passes.push_back({"obscurance-blur", "obscurance_blur", "a blur was asked for", "methods.near_field.blur"});
  if (near_field.half_resolution)
    plan.passes.push_back(
        {"obscurance-upsample", "obscurance_upsample", "half resolution", "methods.near_field.half_resolution"});
}

struct NearFieldPasses::Impl {
  Impl(Device& device, const Methods& methods, std::size_t width, std::size_t height);
  void shade(FragmentPlanes& planes, const ObscuranceView& view, Buffer<float>& visibility);

  NearField options;
  ObscurancePass pass;
  std::optional<OwnNormals> normals;
  std::optional<HalfResolution> half;
  std::optional<ObscuranceBlurPass> blur;
  Buffer<float> scratch;
};

NearFieldPasses::Impl::Impl(Device& device, const Methods& methods, std::size_t width, std::size_t height)
    : options(methods.near_field), pass(obscurance_pass(device, methods)) {
  const std::size_t padded = padded_fragment_count(width * height);
  if (options.normals == "depth") normals.emplace(device, padded);
  if (options.half_resolution) half.emplace(device, width, height);
  if (options.blur == 0) return;
  blur.emplace(device);
  scratch = Buffer<float>(device, half ? half->planes.padded_fragments : padded, "unblurred obscurance");
}

void NearFieldPasses::Impl::shade(FragmentPlanes& planes, const ObscuranceView& view, Buffer<float>& visibility) {
  std::visit([&](auto& obscurance) { obscurance.run(planes, view, visibility); }, pass);
  if (blur) blur->run(planes, view, options.blur, reach_of_radius * options.radius, visibility, scratch);
}

NearFieldPasses::NearFieldPasses(Device& device, const Methods& methods, std::size_t width, std::size_t height)
    : impl_(std::make_unique<Impl>(device, methods, width, height)) {}
NearFieldPasses::~NearFieldPasses() = default;
NearFieldPasses::NearFieldPasses(NearFieldPasses&&) noexcept = default;
NearFieldPasses& NearFieldPasses::operator=(NearFieldPasses&&) noexcept = default;

void NearFieldPasses::run(FragmentPlanes& planes, const ObscuranceView& view, Buffer<float>& visibility) {
  Impl& passes = *impl_;
  if (passes.normals) {
    OwnNormals& own = *passes.normals;
    own.pass.run(planes, view, own.x, own.y, own.z);
    own.swap_with(planes);
  }
  if (passes.half) {
    HalfResolution& half = *passes.half;
    half.halve.run(planes, view, half.planes);
    passes.shade(half.planes, half_view(view), half.visibility);
    half.upsample.run(half.planes, half.visibility, reach_of_radius * passes.options.radius, planes, view, visibility);
  } else {
    passes.shade(planes, view, visibility);
  }
  if (passes.normals) passes.normals->swap_with(planes);
}

ObscuranceView obscurance_view(const CameraView& camera) {
  ObscuranceView view;
  view.right = axis_of(camera.right);
  view.down = axis_of(camera.down);
  view.forward = axis_of(camera.forward);
  view.focal = double{camera.focal};
  view.centre_x = double{camera.centre_x};
  view.centre_y = double{camera.centre_y};
  view.width = camera.width;
  view.height = camera.height;
  return view;
}

ObscuranceView obscurance_view(const Frame& frame) {
  const auto row = [&](int r) {
    return glm::dvec3(frame.world_to_camera[0][r], frame.world_to_camera[1][r], frame.world_to_camera[2][r]);
  };
  ObscuranceView view;
  view.right = glm::vec3(row(0));
  view.down = glm::vec3(-row(1));
  view.forward = glm::vec3(-row(2));
  view.width = frame.width;
  view.height = frame.height;
  view.centre_x = 0.5 * frame.width;
  view.centre_y = 0.5 * frame.height;
  view.perspective = frame.vertical_fov > 0;
  if (!view.perspective && frame.orthographic_height <= 0)
    throw Error(ErrorKind::invalid_input,
                "obscurance needs the camera's field of view or, orthographic, the height of the image in metres: the "
                "file tells neither and its positions determine none");
  view.focal = view.perspective ? 0.5 * frame.height / std::tan(0.5 * frame.vertical_fov)
                                : frame.height / frame.orthographic_height;
  return view;
}

}  // namespace understory
