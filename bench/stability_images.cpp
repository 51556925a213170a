// The stability of what reads an image: obscurance at fields of view from 1 to 170 degrees and orthographic, its blur,
// normals from depth, and the light of an environment.
#include <algorithm>
#include <cmath>
#include <memory>

#include "bench/stability_case.hpp"
#include "host/passes/depth_moments.hpp"
#include "host/passes/environment.hpp"
#include "host/passes/normals_from_depth.hpp"
#include "host/passes/obscurance_area.hpp"
#include "host/passes/obscurance_blur.hpp"
#include "host/passes/obscurance_line.hpp"
#include "host/passes/obscurance_point.hpp"
#include "host/passes/screen_rays.hpp"
#include "tests/reference/environment.hpp"
#include "tests/reference/obscurance_area.hpp"
#include "tests/reference/obscurance_blur.hpp"
#include "tests/reference/screen_rays.hpp"
#include "tests/support/environments.hpp"
#include "tests/support/made_images.hpp"

namespace understory {
namespace {

using reference::DepthImage;

using Image = std::shared_ptr<const DepthImage>;

constexpr int width = 41, height = 29;

double in_radians(double degrees) { return degrees * std::numbers::pi / 180; }

/// `shade` of a device's planes of the image.
StabilityCase image_case(const std::string& kernel, const std::string& name, Image image,
                         const std::function<void(Device&, FragmentPlanes&, Buffer<float>&)>& pass) {
  StabilityCase one;
  one.kernel = kernel;
  one.name = name;
  one.shade = [image, pass](Device& device) {
    FragmentPlanes planes = upload_image(device, *image);
    Buffer<float> visibility(device, planes.padded_fragments, "visibility");
    pass(device, planes, visibility);
    return Shaded{first_of(visibility, planes.fragments), first_of(planes.validity, planes.fragments)};
  };
  return one;
}

using ExactPixel = std::function<reference::Obscurance(int x, int y)>;

/// One of the ways to sample, and its double.
struct Sampling {
  std::string name;
  std::function<void(Device&, FragmentPlanes&, const ObscuranceView&, const NearField&, Buffer<float>&)> run;
  ExactPixel (*exact)(const Image&, const NearField&);
};

/// Rays take surfaces to have some depth.
NearField with_depth(NearField near) {
  if (near.thickness == 0) near.thickness = 0.05 * near.radius;
  return near;
}

const std::vector<Sampling>& samplings() {
  static const std::vector<Sampling> all = {
      {"obscurance-line",
       [](Device& device, FragmentPlanes& planes, const ObscuranceView& view, const NearField& near,
          Buffer<float>& out) { ObscuranceLinePass(device, near, line_samples(5)).run(planes, view, out); },
       [](const Image& image, const NearField& near) -> ExactPixel {
         return
             [=](int x, int y) { return reference::line_obscurance(*image, x, y, line_samples(5), near, near.radius); };
       }},
      {"obscurance-point",
       [](Device& device, FragmentPlanes& planes, const ObscuranceView& view, const NearField& near,
          Buffer<float>& out) { ObscurancePointPass(device, near, point_samples(12)).run(planes, view, out); },
       [](const Image& image, const NearField& near) -> ExactPixel {
         return [=](int x, int y) {
           return reference::point_obscurance(*image, x, y, point_samples(12), near, near.radius);
         };
       }},
      {"obscurance-area",
       [](Device& device, FragmentPlanes& planes, const ObscuranceView& view, const NearField& near,
          Buffer<float>& out) {
         DepthMomentsPass gather(device);
         DepthMoments moments = gather.allocate(device, view);
         gather.run(planes, view, moments);
         ObscuranceAreaPass(device, near, line_samples(5), std::sqrt(3.0)).run(planes, view, moments, out);
       },
       [](const Image& image, const NearField& near) -> ExactPixel {
         const auto pyramid = std::make_shared<const reference::MomentPyramid>(*image);
         return [=](int x, int y) {
           return reference::area_obscurance(*image, *pyramid, x, y, line_samples(5), near, near.radius,
                                             std::sqrt(3.0));
         };
       }},
      {"screen-rays",
       [](Device& device, FragmentPlanes& planes, const ObscuranceView& view, const NearField& near,
          Buffer<float>& out) { ScreenRaysPass(device, with_depth(near), 5).run(planes, view, out); },
       [](const Image& image, const NearField& near) -> ExactPixel {
         return [=](int x, int y) {
           const reference::ScreenRays rays = reference::screen_rays(*image, x, y, 5, with_depth(near));
           return reference::Obscurance{rays.value, 1, static_cast<double>(rays.doubtful)};
         };
       }}};
  return all;
}

std::function<double(std::size_t)> exact_of(const Sampling& sampling, const Image& image, const NearField& near) {
  return [image, exact = sampling.exact(image, near)](std::size_t i) {
    if (std::isinf(image->depth[i])) return 1.0;
    const int x = static_cast<int>(i) % image->view.width, y = static_cast<int>(i) / image->view.width;
    const reference::Obscurance o = exact(x, y);
    // A sample on the border between two pixels, or as deep as what is seen, may count to either side.
    return o.nearest_edge < 2e-3 || o.doubt > 0 ? std::nan("") : o.value;
  };
}

/// Both directions of the blur, the plane between them in float.
std::function<double(std::size_t)> exact_blur(const Image& image, std::vector<double> values, int radius,
                                              double reach) {
  for (const bool down : {false, true}) values = reference::blurred(*image, values, radius, down, reach);
  return [values = std::move(values)](std::size_t i) { return values[i]; };
}

void add_obscurance(const Sampling& sampling, std::vector<StabilityCase>& all) {
  const auto add = [&](const std::string& name, const ObscuranceView& view, const Surface& surface,
                       const NearField& near, bool comparable = true) -> StabilityCase& {
    const auto image = std::make_shared<const DepthImage>(image_of(view, surface));
    const auto run = sampling.run;
    all.push_back(
        image_case(sampling.name, name, image, [=](Device& device, FragmentPlanes& planes, Buffer<float>& out) {
          run(device, planes, image->view, near, out);
        }));
    StabilityCase& one = all.back();
    if (comparable) one.exact = exact_of(sampling, image, near);
    if (sampling.name == "screen-rays") {
      one.stated_error = 5e-6;
      one.note = "angles within 4e-6 turn rays, and so how long they are behind things";
    }
    return one;
  };
  NearField near;
  near.radius = 1;
  for (const double fov : {1.0, 10.0, 60.0, 120.0, 170.0}) {
    // Eight pixels to the radius; then the ball does not reach behind the camera.
    const double eight_pixels = 80 * 2 * std::tan(in_radians(fov) / 2) / height;
    const ObscuranceView view = odd_view(width, height, in_radians(fov));
    const std::string name = "field of view " + std::to_string(static_cast<int>(fov)) + " degrees";
    near.radius = std::min(eight_pixels, 5.0);
    add(name, fov > 150 ? odd_view(5 * width, 5 * height, in_radians(fov)) : view, patchwork(7, 10, near.radius), near)
        .extreme = fov != 60;
    if (sampling.name == "obscurance-area") {
      all.back().stated_error = fov > 150 ? 1e-3 : 1e-6;
      all.back().note =
          "depths spread by the root of a difference of variances: 1e-6, and 1e-3 where rays are 85 degrees "
          "off the axis";
    }
    if (eight_pixels <= 5) continue;
    near.radius = eight_pixels;
    add(name + ", a ball that the camera is in", view, patchwork(7, 10, near.radius), near, false);
  }
  near.radius = 1;
  add("orthographic", odd_view(width, height, 0), patchwork(7, 10, 1), near);
  NearField all_options = near;
  all_options.thickness = 1.5;
  if (sampling.name == "screen-rays") {
    add("thickness", odd_view(width, height, 0.9), patchwork(8, 12, 1), all_options);
  } else {
    all_options.normals = "none";
    add("thickness, without normals", odd_view(width, height, 0.9), patchwork(8, 12, 1), all_options);
  }
  for (const double depth : {1e-4, 1e7}) {
    NearField scaled = near;
    scaled.radius = 0.1 * depth;
    const std::string name = depth < 1 ? "depths at a near plane of 1e-4 m" : "depths at 1e7 m";
    add(name, odd_view(width, height, 0.9), patchwork(9, depth, 0.1 * depth), scaled);
  }
  for (const double radius : {1e-6, 1e6}) {
    NearField scaled = near;
    scaled.radius = radius;
    add(radius < 1 ? "radius 1e-6 m, below a pixel" : "radius 1e6 m, beyond the image", odd_view(width, height, 0.9),
        patchwork(9, 10, 1), scaled);
    if (radius > 1 || sampling.name != "obscurance-area") continue;
    all.back().stated_error = 1;
    all.back().note = "a radius below the rounding of depths, which are kept as 1/z; code 32 is set";
  }
  add(
      "background only", odd_view(width, height, 0.9), [](const reference::PixelRay&) { return SurfacePoint{}; }, near);
  const float bad[] = {0.0f, -1.0f, 1e-44f, NAN, 3e38f, -INFINITY, 10.0f};
  int number = 0;
  const Surface broken = [&bad, &number](const reference::PixelRay&) {
    SurfacePoint point;
    point.depth = double(bad[number % 7]);
    const double n = double(bad[number++ / 7 % 7]);
    point.normal = {n, 0, -1};
    return point;
  };
  add("zero, NaN and infinite depths and normals", odd_view(width, height, 0.9), broken, near, false);
}

void add_blur_and_normals(std::vector<StabilityCase>& all) {
  for (const double fov : {1.0, 60.0, 170.0, 0.0}) {
    const double span = fov == 0 ? 1 : 2 * std::tan(in_radians(fov) / 2) * 10 / height * 8;
    const auto image =
        std::make_shared<const DepthImage>(image_of(odd_view(width, height, in_radians(fov)), patchwork(5, 10, span)));
    const std::string name = fov == 0 ? "orthographic" : "field of view " + std::to_string(static_cast<int>(fov));
    const auto bright_at = [](std::size_t i) { return static_cast<float>(i % 11) / 10; };
    all.push_back(
        image_case("obscurance-blur", name, image, [=](Device& device, FragmentPlanes& planes, Buffer<float>& out) {
          std::vector<float> bright(planes.padded_fragments);
          for (std::size_t i = 0; i < bright.size(); ++i) bright[i] = bright_at(i);
          out.write(bright);
          Buffer<float> scratch(device, planes.padded_fragments, "scratch");
          ObscuranceBlurPass(device).run(planes, image->view, 4, 0.3 * span, out, scratch);
        }));
    std::vector<double> bright;
    for (std::size_t i = 0; i < image->depth.size(); ++i) bright.push_back(double(bright_at(i)));
    all.back().exact = exact_blur(image, bright, 4, 0.3 * span);
    // Values are half the length of each normal: 1/2, and 0 on the background.
    all.push_back(
        image_case("normals-from-depth", name, image, [=](Device& device, FragmentPlanes& planes, Buffer<float>& out) {
          Buffer<float> n[3];
          for (Buffer<float>& axis : n) axis = Buffer<float>(device, planes.padded_fragments, "normal");
          NormalsFromDepthPass(device).run(planes, image->view, n[0], n[1], n[2]);
          const std::vector<float> x = n[0].read(), y = n[1].read(), z = n[2].read();
          std::vector<float> half(x.size());
          for (std::size_t i = 0; i < half.size(); ++i) half[i] = 0.5f * glm::length(glm::vec3(x[i], y[i], z[i]));
          out.write(half);
        }));
    all.back().exact = [image](std::size_t i) { return std::isinf(image->depth[i]) ? 0.0 : 0.5; };
  }
}

/// Light of a sky of at most 1, red channel, beside cones of every aperture and share.
void add_environment(std::size_t samples, std::vector<StabilityCase>& all) {
  const auto environment =
      std::make_shared<const PrefilteredEnvironment>(prefilter(smooth_environment(), 0, Sky::dome));
  std::vector<TestFragment> fragments;
  const auto cones = std::make_shared<std::vector<reference::ConeOfFragment>>();
  const auto visibility = std::make_shared<std::vector<float>>();
  const auto add = [&](const glm::vec3& n, double aperture, double share, double rest) {
    Random random = case_random("lit", fragments.size());
    fragments.push_back({glm::vec3(1), n});
    cones->push_back({glm::dvec3(random_direction(random)), as_float(aperture), as_float(share)});
    visibility->push_back(static_cast<float>(rest * (1 - cones->back().share)));
  };
  for (std::size_t i = 0; i < samples; ++i) {
    Random random = case_random("light", i);
    add(random_direction(random), random.uniform(0, 0.6), random.uniform(0, 0.9), random.uniform());
  }
  for (const glm::vec3 n : stability_directions(0))
    for (const double aperture : {0.0, 1e-6, 0.5, 1.0})
      for (const double share : {0.0, 1e-6, 0.5, 1.0}) add(n, aperture, share, 1);
  const FragmentModel model{[=](Device& device, FragmentPlanes& planes, Buffer<float>& out) {
    const auto plane = [&](float wild, auto member) {
      std::vector<float> values(planes.padded_fragments, wild);
      for (std::size_t i = 0; i < std::min(values.size(), cones->size()); ++i)
        values[i] = static_cast<float>(member(i));
      return Buffer<float>(device, std::span<const float>(values), "cones");
    };
    const Buffer<float> v = plane(NAN, [&](std::size_t i) { return (*visibility)[i]; });
    const ConePlanes cone{plane(NAN, [&](std::size_t i) { return (*cones)[i].axis.x; }),
                          plane(INFINITY, [&](std::size_t i) { return (*cones)[i].axis.y; }),
                          plane(0, [&](std::size_t i) { return (*cones)[i].axis.z; }),
                          plane(-1, [&](std::size_t i) { return (*cones)[i].aperture; }),
                          plane(NAN, [&](std::size_t i) { return (*cones)[i].share; })};
    const EnvironmentTables tables(device, *environment, Sky::dome);
    std::array<Buffer<float>, 3> light;
    for (Buffer<float>& colour : light) colour = Buffer<float>(device, planes.padded_fragments, "light");
    EnvironmentPass(device).run(planes, upload_owners(device, std::vector<Owner>(2)), v, &cone, tables, {}, light);
    out.write(light[0].read());
  }};
  all.push_back(fragment_case("environment", "cones of every aperture and share", fragments, model));
  all.back().exact = [=](std::size_t i) {
    if ((*cones)[i].share >= 1) return std::nan("");  // nothing is left: either form's 0/0
    return reference::environment(*environment, glm::dvec3(fragments[i].normal), double((*visibility)[i]), (*cones)[i])
        .x;
  };
  all.push_back(fragment_case("environment", "zero, NaN and infinite numbers", garbage(1), model));
}

}  // namespace

std::vector<StabilityCase> image_stability(std::size_t samples) {
  std::vector<StabilityCase> all;
  for (const Sampling& sampling : samplings()) add_obscurance(sampling, all);
  add_blur_and_normals(all);
  add_environment(samples, all);
  return all;
}

}  // namespace understory
