// The farthest depth of every tile against a look at every pixel: sizes that are no multiple of a tile, and empty ones.
#include "host/passes/farthest_depth.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "kernels/shared/farthest_depth.h"
#include "sim/error.hpp"
#include "sim/random.hpp"
#include "tests/reference/farthest_depth.hpp"

namespace understory {
namespace {

/// Of depths of many magnitudes; some pixels show nothing, all of the first tile something.
std::vector<float> random_depths(int width, int height) {
  Random random(3, static_cast<std::uint64_t>(width));
  std::vector<float> depth;
  for (int i = 0; i < width * height; ++i)
    depth.push_back(random.uniform() < 0.01 && i % width >= 8 ? INFINITY
                                                              : static_cast<float>(std::exp2(random.uniform(-20, 20))));
  return depth;
}

/// As the rasteriser leaves it: depth bits above the triangle.
VisibilityBuffer drawn(Device& device, const std::vector<float>& depth) {
  std::vector<std::uint32_t> words;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const bool nothing = std::isinf(depth[i]);
    words.push_back(nothing ? 0xffffffffu : static_cast<std::uint32_t>(7 * i));
    words.push_back(nothing ? 0xffffffffu : std::bit_cast<std::uint32_t>(depth[i]));
  }
  return {Buffer<std::uint32_t>(device, std::span<const std::uint32_t>(words), "visible")};
}

std::vector<float> on_device(Device& device, const std::vector<float>& depth, int width) {
  CameraView camera{};
  camera.width = width;
  camera.height = static_cast<int>(depth.size()) / width;
  const auto tiles = [](int pixels) { return std::size_t{farthest_tiles(static_cast<std::uint32_t>(pixels))}; };
  Buffer<float> farthest(device, tiles(width) * tiles(camera.height), "farthest");
  FarthestDepthPass(device).run(drawn(device, depth), camera, farthest);
  return farthest.read();
}

TEST(FarthestDepth, IsThatOfTheReference) {
  Device device;
  for (const auto& [width, height] : {std::pair{1, 1}, {8, 8}, {17, 3}, {67, 45}, {100, 9}}) {
    const std::vector<float> depth = random_depths(width, height);
    EXPECT_EQ(on_device(device, depth, width), reference::farthest_depth(depth, width, static_cast<int>(FARTHEST_TILE)))
        << width << " x " << height;
  }
}

TEST(FarthestDepth, OfAnEmptyBufferIsInfinite) {
  Device device;
  for (const float depth : on_device(device, std::vector<float>(20 * 10, INFINITY), 20)) EXPECT_TRUE(std::isinf(depth));
}

TEST(FarthestDepth, RefusesBuffersOfOtherSizes) {
  Device device;
  CameraView camera{};
  camera.width = camera.height = 16;
  Buffer<float> farthest(device, 3, "farthest");
  EXPECT_THROW(FarthestDepthPass(device).run(drawn(device, std::vector<float>(256, 1)), camera, farthest), Error);
}

}  // namespace
}  // namespace understory
