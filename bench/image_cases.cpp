// Obscurance and the passes about it on one tilted plane, of which everything is known: it is open, its normal is the
// same everywhere, and the reciprocal of its depth is linear in the pixel.
#include <cmath>
#include <memory>

#include "bench/kernel_cases.hpp"
#include "host/passes/check_fragments.hpp"
#include "host/passes/normals_from_depth.hpp"
#include "host/passes/obscurance_area.hpp"
#include "host/passes/obscurance_blur.hpp"
#include "host/passes/obscurance_half.hpp"
#include "host/passes/obscurance_line.hpp"
#include "host/passes/obscurance_point.hpp"
#include "host/passes/screen_rays.hpp"

namespace understory {
namespace {

constexpr double focal = 2000, distance = 20;
const glm::dvec3 tilted = glm::normalize(glm::dvec3(0.3, -0.2, -1));  // right, down, forward

NearField near_field() {
  NearField options;
  options.radius = 0.12;  // 12 pixels
  return options;
}

/// The plane of distance 20 m on the axis of view, as an image of so many fragments.
struct TiltedImage {
  TiltedImage(Device& device, const BenchFragments& all)
      : width(all.planes.row_length), height(all.planes.fragments / width) {
    view.width = static_cast<int>(width);
    view.height = static_cast<int>(height);
    view.focal = focal;
    view.centre_x = 0.5 * double(width);
    view.centre_y = 0.5 * double(height);
    planes = allocate_planes(device, width, height, false);
    visibility = Buffer<float>(device, planes.padded_fragments, "obscurance");
    scratch = Buffer<float>(device, planes.padded_fragments, "scratch");
    const std::size_t count = planes.padded_fragments;
    std::vector<float> depth(count, 1.0f);
    for (std::size_t i = 0; i < planes.fragments; ++i)
      depth[i] = static_cast<float>(1 / inverse_depth(double(i % width), double(i / width)));
    planes.depth.write(depth);
    const glm::vec3 world = glm::mat3(view.right, view.down, view.forward) * glm::vec3(tilted);
    planes.normal_x.write(std::vector<float>(count, world.x));
    planes.normal_y.write(std::vector<float>(count, world.y));
    planes.normal_z.write(std::vector<float>(count, world.z));
    planes.validity.write(std::vector<std::uint32_t>(count, 0));
  }

  /// At the centre of a pixel, 1/m.
  double inverse_depth(double x, double y) const {
    const double right = (x + 0.5 - view.centre_x) / view.focal, down = (y + 0.5 - view.centre_y) / view.focal;
    return (tilted.x * right + tilted.y * down + tilted.z) / (tilted.z * distance);
  }

  /// Largest deviation of a plane from a number, away from the image's borders.
  double deviation(const Buffer<float>& of, double expected) const {
    const std::vector<float> values = of.read();
    double largest = 0;
    for (std::size_t y = 16; y + 16 < height; y += 3)
      for (std::size_t x = 16; x + 16 < width; x += 13) {
        const double error = std::abs(double(values[y * width + x]) - expected);
        largest = std::isfinite(error) ? std::max(largest, error) : HUGE_VAL;
      }
    return largest;
  }

  std::size_t width, height;
  ObscuranceView view;
  FragmentPlanes planes;
  Buffer<float> visibility, scratch;
};

using Image = std::shared_ptr<TiltedImage>;

/// `build` makes what runs the pass; `error` judges the image afterwards.
KernelCase image_case(const std::string& kernel, double tolerance,
                      const std::function<std::function<void()>(Device&, Image)>& build,
                      const std::function<double(const TiltedImage&)>& error) {
  return {kernel, tolerance, [=](Device& device, BenchFragments& all) {
            const Image image = std::make_shared<TiltedImage>(device, all);
            return ReadyKernel{build(device, image), [image, error] { return error(*image); },
                               static_cast<double>(image->planes.padded_fragments)};
          }};
}

double closedness(const TiltedImage& image) { return image.deviation(image.visibility, 1); }

KernelCase area_case() {
  return image_case(
      "obscurance-area", 2e-3,
      [](Device& device, Image image) {
        const auto gather = std::make_shared<DepthMomentsPass>(device);
        const auto moments = std::make_shared<DepthMoments>(gather->allocate(device, image->view));
        gather->run(image->planes, image->view, *moments);
        const auto pass = std::make_shared<ObscuranceAreaPass>(device, near_field(), line_samples(4));
        return [=] { pass->run(image->planes, image->view, *moments, image->visibility); };
      },
      closedness);
}

KernelCase moments_case() {
  return {"depth-moments", 1e-5, [](Device& device, BenchFragments& all) {
            const Image image = std::make_shared<TiltedImage>(device, all);
            const auto pass = std::make_shared<DepthMomentsPass>(device);
            const auto moments = std::make_shared<DepthMoments>(pass->allocate(device, image->view));
            ReadyKernel ready;
            ready.run = [=] { pass->run(image->planes, image->view, *moments); };
            ready.error = [=] {  // a texel of level 1 lies between pixels 2 x and 2 x + 1
              const MomentLevel& level = moments->levels.size() > 1 ? moments->levels[1] : moments->levels[0];
              const std::vector<float> mean = moments->mean.read();
              double largest = 0;
              for (int y = 1; y + 2 < level.height; ++y)
                for (int x = 1; x + 2 < level.width; x += 7) {
                  const double expected = image->inverse_depth(2 * x + 0.5, 2 * y + 0.5) * distance;
                  const auto texel = level.first + static_cast<std::uint32_t>(y * level.width + x);
                  const double error = std::abs(double(mean[texel]) * distance - expected);
                  largest = std::isfinite(error) ? std::max(largest, error) : HUGE_VAL;
                }
              return largest;
            };
            ready.items = static_cast<double>(image->planes.padded_fragments);
            return ready;
          }};
}

/// A constant stays what it is, however often it is blurred.
KernelCase blur_case() {
  return image_case(
      "obscurance-blur", 1e-5,
      [](Device& device, Image image) {
        image->visibility.write(std::vector<float>(image->planes.padded_fragments, 0.375f));
        return [image, pass = std::make_shared<ObscuranceBlurPass>(device)] {
          pass->run(image->planes, image->view, 4, 0.2 * near_field().radius, image->visibility, image->scratch);
        };
      },
      [](const TiltedImage& image) { return image.deviation(image.visibility, 0.375); });
}

FragmentPlanes half_planes(Device& device, const TiltedImage& image) {
  const ObscuranceView half = half_view(image.view);
  return allocate_planes(device, static_cast<std::size_t>(half.width), static_cast<std::size_t>(half.height), false);
}

KernelCase half_case() {
  return {"obscurance-half", 1e-6, [](Device& device, BenchFragments& all) {
            const Image image = std::make_shared<TiltedImage>(device, all);
            const auto half = std::make_shared<FragmentPlanes>(half_planes(device, *image));
            ReadyKernel ready;
            ready.run = [=, pass = std::make_shared<ObscuranceHalfPass>(device)] {
              pass->run(image->planes, image->view, *half);
            };
            ready.error = [=] {
              const std::vector<float> depth = half->depth.read(), normal = half->normal_z.read();
              const std::vector<float> wide = image->planes.normal_z.read();
              double largest = 0;
              for (std::size_t i = 0; i < half->fragments; i += 17) {
                const double x = 2 * double(i % half->row_length), y = 2 * double(i / half->row_length);
                const double error = std::max(std::abs(double(depth[i]) * image->inverse_depth(x, y) - 1),
                                              std::abs(double(normal[i]) - double(wide[0])));
                largest = std::isfinite(error) ? std::max(largest, error) : HUGE_VAL;
              }
              return largest;
            };
            ready.items = static_cast<double>(half->padded_fragments);
            return ready;
          }};
}

KernelCase upsample_case() {
  return image_case(
      "obscurance-upsample", 1e-5,
      [](Device& device, Image image) {
        const auto half = std::make_shared<FragmentPlanes>(half_planes(device, *image));
        ObscuranceHalfPass(device).run(image->planes, image->view, *half);
        const auto small = std::make_shared<Buffer<float>>(device, half->padded_fragments, "half obscurance");
        small->write(std::vector<float>(half->padded_fragments, 0.375f));
        return [=, pass = std::make_shared<ObscuranceUpsamplePass>(device)] {
          pass->run(*half, *small, 0.2 * near_field().radius, image->planes, image->view, image->visibility);
        };
      },
      [](const TiltedImage& image) { return image.deviation(image.visibility, 0.375); });
}

/// A step of one pixel over the plane, in float depths, turns the normal by about 1e-4.
KernelCase normals_case() {
  return image_case(
      "normals-from-depth", 2e-3,
      [](Device& device, Image image) {
        const auto other = std::make_shared<Buffer<float>>(device, image->planes.padded_fragments, "normal");
        return [=, pass = std::make_shared<NormalsFromDepthPass>(device)] {
          pass->run(image->planes, image->view, image->visibility, image->scratch, *other);
        };
      },
      [](const TiltedImage& image) {
        return std::max(image.deviation(image.visibility, tilted.x), image.deviation(image.scratch, -tilted.y));
      });
}

/// Nothing is wrong with the plane's normals and positions: no code is set.
KernelCase check_case() {
  return image_case(
      "check-fragments", 0,
      [](Device& device, Image image) {
        return [image, pass = std::make_shared<CheckFragmentsPass>(device)] { pass->run(image->planes); };
      },
      [](const TiltedImage& image) {
        double largest = 0;
        for (const std::uint32_t code : image.planes.validity.read()) largest = std::max(largest, double(code));
        return largest;
      });
}

}  // namespace

std::vector<KernelCase> image_cases() {
  return {check_case(),
          normals_case(),
          image_case(
              "obscurance-line", 2e-3,
              [](Device& device, Image image) {
                const auto pass = std::make_shared<ObscuranceLinePass>(device, near_field(), line_samples(5));
                return [=] { pass->run(image->planes, image->view, image->visibility); };
              },
              closedness),
          image_case(
              "obscurance-point", 2e-3,
              [](Device& device, Image image) {
                const auto pass = std::make_shared<ObscurancePointPass>(device, near_field(), point_samples(12));
                return [=] { pass->run(image->planes, image->view, image->visibility); };
              },
              closedness),
          image_case(
              "screen-rays", 2e-3,
              [](Device& device, Image image) {
                NearField options = near_field();
                options.thickness = 0.012;
                const auto pass = std::make_shared<ScreenRaysPass>(device, options, 16);
                return [=] { pass->run(image->planes, image->view, image->visibility); };
              },
              closedness),
          moments_case(),
          area_case(),
          blur_case(),
          half_case(),
          upsample_case()};
}

}  // namespace understory
