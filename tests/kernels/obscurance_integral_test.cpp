// Lines and points converge to one integral, that of the depth plane itself.
#include <gtest/gtest.h>

#include "host/passes/obscurance_line.hpp"
#include "host/passes/obscurance_point.hpp"
#include "tests/reference/obscurance_integral.hpp"
#include "tests/support/depth_images.hpp"

namespace understory {
namespace {

constexpr int many = 1024;
constexpr double golden_turn = 2 * std::numbers::pi * 0.6180339887498949;

/// Of equal shares of the ball: lines through the disc, or points. None of the published sets.
std::vector<ObscuranceSample> many_samples(bool lines) {
  std::vector<ObscuranceSample> samples;
  for (int i = 0; i < many; ++i) {
    const double share = (i + 0.5) / many, turn = golden_turn * i;
    // The ball's volume within r of its axis is 1 - (1 - r^2)^(3/2); points fill shells by steps of an irrational
    // number.
    const double shell = std::cbrt(std::fmod(i * 0.7548776662466927 + 0.5, 1.0)), z = lines ? 0 : 1 - 2 * share;
    const double r = lines ? std::sqrt(1 - std::pow(1 - share, 2.0 / 3)) : shell * std::sqrt(1 - z * z);
    samples.push_back({static_cast<float>(r * std::cos(turn)), static_cast<float>(r * std::sin(turn)),
                       static_cast<float>(shell * z), 1.0f / many, 0});
  }
  return samples;
}

Shaded shade(Device& device, const reference::DepthImage& image, const ObscuranceSampleSet& set, bool lines,
             const NearField& options) {
  FragmentPlanes planes = upload_image(device, image);
  Buffer<float> visibility(device, planes.padded_fragments, "visibility");
  if (lines)
    ObscuranceLinePass(device, options, set, 0).run(planes, image.view, visibility);
  else
    ObscurancePointPass(device, options, set, 0).run(planes, image.view, visibility);
  return {first_of(visibility, planes.fragments), first_of(planes.validity, planes.fragments)};
}

/// RMSE of V from the integral, of the pixels whose balls are inside the image.
double rmse_of(Device& device, const reference::DepthImage& image, bool lines, double radius) {
  const std::vector<ObscuranceSample> samples = many_samples(lines);
  NearField options;
  options.falloff = "cosine";
  options.radius = radius;
  const Shaded shaded = shade(device, image, {samples, false, 0, 0, 0}, lines, options);
  double sum = 0;
  int count = 0;
  for (int y = 0; y < image.view.height; ++y)
    for (int x = 0; x < image.view.width; ++x) {
      const auto i = static_cast<std::size_t>(y * image.view.width + x);
      if (shaded.validity[i] != 0) continue;
      const double error = double{shaded.visibility[i]} - reference::obscurance_integral(image, x, y, radius);
      sum += error * error;
      ++count;
    }
  EXPECT_GT(count, 1000);
  return std::sqrt(sum / count);
}

TEST(ObscuranceIntegral, IsWhatLinesAndPointsConvergeTo) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  for (const double field_of_view : {0.0, 0.7}) {
    const ObscuranceView view = odd_view(96, 72, field_of_view);
    // Balls of 12 and of 30 pixels: an eighth and a third of the distance.
    for (const double pixels : {12.0, 30.0}) {
      const double depth = view.perspective ? 5 : 7, radius = pixels * (view.perspective ? depth : 1) / view.focal;
      const reference::DepthImage image = image_of(view, patchwork(11, depth, 0.8 * radius));
      const double points = rmse_of(device, image, false, radius), lines = rmse_of(device, image, true, radius);
      EXPECT_LT(points, 0.008) << field_of_view << ", " << pixels << " pixels";
      // Lines are parallel to the fragment's own sight, rays spread: by a third over the widest of these balls.
      EXPECT_LT(lines, view.perspective && radius > 0.2 * depth ? 0.04 : 0.015)
          << field_of_view << ", " << pixels << " pixels";
    }
  }
}

TEST(ObscuranceIntegral, OfFewSamplesIsTheSameOnTheMean) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  NearField options;
  options.radius = 0.5;
  options.normals = "none";
  const reference::DepthImage image = image_of(odd_view(96, 64, 1.0), patchwork(9, 3, 1.2));
  const auto mean = [&](const ObscuranceSampleSet& set, bool lines) {
    double sum = 0;
    const Shaded shaded = shade(device, image, set, lines, options);
    for (const float v : shaded.visibility) sum += double{v};
    return sum / static_cast<double>(shaded.visibility.size());
  };
  EXPECT_NEAR(mean(line_samples(9), true), mean(line_samples(16), true), 0.01);
  EXPECT_NEAR(mean(line_samples(16), true), mean(point_samples(33), false), 0.03);
}

}  // namespace
}  // namespace understory
