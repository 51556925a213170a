// obscurance-area: the pyramid of moments against plain sums, its integral, and flat surfaces of any slant.
#include "host/passes/obscurance_area.hpp"

#include <gtest/gtest.h>

#include "host/passes/obscurance_line.hpp"
#include "kernels/shared/obscurance.h"
#include "tests/reference/obscurance_area.hpp"
#include "tests/support/depth_images.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/tolerances.hpp"

namespace understory {
namespace {

const double pi = std::numbers::pi;

Shaded shade(const reference::DepthImage& image, int samples, const NearField& options) {
  return shade_image(image, [&](Device& device, int lanes, FragmentPlanes& planes, Buffer<float>& visibility) {
    DepthMomentsPass gather(device);
    DepthMoments moments = gather.allocate(device, image.view);
    gather.run(planes, image.view, moments);
    ObscuranceAreaPass(device, options, line_samples(samples), 1, lanes).run(planes, image.view, moments, visibility);
  });
}

TEST(ObscuranceArea, IntegralIsThatOfTheLinearOpenness) {
  // Against 20000 steps; 0 spread is the step of a line.
  for (const double half : {1.0, 0.4})
    for (const double end : {2.0, 0.3, -0.2, -2.0})
      for (const double mean : {-3.0, -0.5, 0.1, 0.6, 4.0})
        for (const double spread : {0.05, 0.4, 3.0}) {
          double sum = 0;
          const double top = std::clamp(end, -half, half);
          constexpr int steps = 20000;
          for (int i = 0; i < steps; ++i) {
            const double z = -half + (top + half) * (i + 0.5) / steps;
            sum += std::clamp((mean + spread - z) / (2 * spread), 0.0, 1.0) * (top + half) / steps;
          }
          EXPECT_NEAR(box_integral(half, end, mean, spread), sum, 1e-4);
          EXPECT_NEAR(box_integral(half, end, mean, 0.0), line_integral(half, std::min(end, mean), 0), 2e-5);
        }
}

TEST(ObscuranceArea, MomentsAreThoseOfPlainSums) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  for (const double field_of_view : {0.9, 0.0}) {
    // Far away: squares of depths would cancel in float.
    const reference::DepthImage image = image_of(odd_view(23, 18, field_of_view), patchwork(7, 800, 1));
    FragmentPlanes planes = upload_image(device, image);
    DepthMomentsPass gather(device);
    DepthMoments moments = gather.allocate(device, image.view);
    gather.run(planes, image.view, moments);
    const std::vector<float> mean = moments.mean.read(), variance = moments.variance.read(),
                             coverage = moments.coverage.read();
    // A texel of the second level away from the borders: the taps 1 3 3 1 applied twice, as weights of pixels.
    const double taps[10] = {1, 3, 6, 10, 12, 12, 10, 6, 3, 1};
    const MomentLevel& level = moments.levels[2];
    for (int y = 1; y < level.height - 2; ++y)
      for (int x = 1; x < level.width - 2; ++x) {
        double all = 0, covered = 0, sum = 0, square = 0;
        for (int pass = 0; pass < 2; ++pass)
          for (int row = 0; row < 10; ++row)
            for (int column = 0; column < 10; ++column) {
              const double depth = image.depth_at(4 * x - 3 + column, 4 * y - 3 + row);
              const double weight = taps[row] * taps[column];
              const double value = image.view.perspective ? 1 / depth : -depth;
              if (pass == 0) all += weight;
              if (std::isinf(depth)) continue;
              if (pass == 0)
                covered += weight, sum += weight * value;
              else
                square += weight * (value - sum / covered) * (value - sum / covered);
            }
        const std::size_t texel = level.first + static_cast<std::size_t>(y * level.width + x);
        EXPECT_NEAR(coverage[texel], covered / all, 1e-5);
        EXPECT_NEAR(mean[texel], sum / covered, 1e-6 * std::abs(sum / covered));
        EXPECT_NEAR(std::sqrt(variance[texel]), std::sqrt(square / covered), 2e-3 * std::sqrt(square / covered));
      }
  }
}

TEST(ObscuranceArea, AgreesWithTheReference) {
  UNDERSTORY_NEEDS_DEVICE();
  NearField options;
  options.radius = 3;
  for (const double field_of_view : {0.9, 0.0}) {
    const reference::DepthImage image = image_of(odd_view(41, 29, field_of_view), patchwork(7, 10, 3));
    const reference::MomentPyramid pyramid(image);
    const Shaded shaded = shade(image, 5, options);
    int compared = 0;
    for (std::size_t i = 0; i < shaded.visibility.size(); ++i) {
      if (std::isinf(image.depth[i])) continue;
      const int x = static_cast<int>(i) % 41, y = static_cast<int>(i) / 41;
      const auto exact = reference::area_obscurance(image, pyramid, x, y, line_samples(5), options, options.radius, 1);
      if (exact.nearest_edge < 2e-3 || exact.doubt > 0) continue;
      ++compared;
      EXPECT_NEAR(shaded.visibility[i], exact.value, 2e-5) << x << ", " << y;
    }
    EXPECT_GT(compared, 300);
  }
}

TEST(ObscuranceArea, FlatSurfacesAreOpen) {
  UNDERSTORY_NEEDS_DEVICE();
  NearField options;
  for (const double field_of_view : {0.1, 0.4, 0.0})  // no horizon comes into view
    for (const double tilt : {0.0, 79.5})
      for (const int samples : {1, 12}) {
        const ObscuranceView view = odd_view(97, 81, field_of_view);
        const glm::dvec3 normal(std::sin(tilt * pi / 180) * 0.6, std::sin(tilt * pi / 180) * 0.8,
                                -std::cos(tilt * pi / 180));
        options.radius = view.perspective ? 0.5 : 0.2;
        const double depth = view.perspective ? view.focal * 0.5 / 4 : 7;  // the ball spans four pixels
        const Shaded shaded = shade(image_of(view, plane_surface({0, 0, depth}, normal)), samples, options);
        for (int y = 32; y < 49; ++y)  // where no footprint reaches the border
          for (int x = 40; x < 57; ++x)
            ASSERT_NEAR(shaded.visibility[static_cast<std::size_t>(y * 97 + x)], 1, 1e-3)
                << samples << " areas, field of view " << field_of_view << ", tilt " << tilt;
      }
}

TEST(ObscuranceArea, OneSampleDarkensCreases) {
  UNDERSTORY_NEEDS_DEVICE();
  const ObscuranceView view = odd_view(96, 64, 0);
  const reference::DepthImage image = image_of(view, [&](const reference::PixelRay& ray) {
    return SurfacePoint{ray.origin.x > 0 ? 3.0 : 9.0, {0, 0, -1}};
  });
  NearField options;
  options.radius = 0.5;
  const Shaded shaded = shade(image, 1, options);
  const int edge = static_cast<int>(view.centre_x);
  const auto at = [&](int x) { return shaded.visibility[static_cast<std::size_t>(32 * 96 + x)]; };
  EXPECT_LT(at(edge - 2), 0.8);
  EXPECT_GT(at(edge - 30), 0.99) << "far from the step";
  EXPECT_LT(at(edge - 2), at(edge - 8));
}

TEST(ObscuranceArea, GarbageStaysWithinBounds) {
  UNDERSTORY_NEEDS_DEVICE();
  const float bad[] = {NAN, INFINITY, -INFINITY, 0.0f, 1e-44f, 1e6f, -3e38f, 1e30f, 1e-30f, 2.0f};
  reference::DepthImage image{odd_view(30, 20, 1.0), {}, {}};
  for (std::size_t i = 0; i < 600; ++i) {
    image.depth.push_back(double{bad[i % 10]});
    image.normal.push_back(glm::dvec3(double{bad[i / 10 % 10]}, double{bad[i / 3 % 10]}, double{bad[i / 7 % 10]}));
  }
  NearField options;
  options.second_radius = 1;
  options.thickness = 0.1;
  shade(image, 1, options);  // expects [0, 1]
  options.normals = "none";
  shade(image, 5, options);
}

TEST(ObscuranceArea, HasNoQuadraticFalloff) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  NearField options;
  options.falloff = "quadratic";
  EXPECT_NE(message_of(ErrorKind::invalid_input, [&] { ObscuranceAreaPass(device, options, line_samples(1)); })
                .find("falloff 'quadratic'; allowed: constant"),
            std::string::npos);
}

}  // namespace
}  // namespace understory
