// The farthest depths of tiles on a buffer whose depths are known.
#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>

#include "bench/kernel_cases.hpp"
#include "host/passes/farthest_depth.hpp"
#include "kernels/shared/farthest_depth.h"

namespace understory {
namespace {

/// A buffer whose depths grow along each row, m.
float depth_in_row(std::size_t column) { return 1 + 0.01f * static_cast<float>(column); }

}  // namespace

KernelCase farthest_depth_case() {
  return {"farthest-depth", 0, [](Device& device, BenchFragments& all) {
            struct Drawn {
              FarthestDepthPass pass;
              VisibilityBuffer visible;
              CameraView camera{};
              Buffer<float> farthest;
            };
            const std::size_t width = all.planes.row_length, height = all.planes.fragments / width;
            std::vector<std::uint32_t> words;
            for (std::size_t i = 0; i < width * height; ++i)
              words.insert(words.end(),
                           {static_cast<std::uint32_t>(i), std::bit_cast<std::uint32_t>(depth_in_row(i % width))});
            const auto drawn = std::make_shared<Drawn>(FarthestDepthPass(device));
            drawn->visible.words =
                Buffer<std::uint32_t>(device, std::span<const std::uint32_t>(words), "visibility buffer");
            drawn->camera.width = static_cast<record_int>(width);
            drawn->camera.height = static_cast<record_int>(height);
            const std::size_t columns = farthest_tiles(static_cast<std::uint32_t>(width));
            const std::size_t tiles = columns * farthest_tiles(static_cast<std::uint32_t>(height));
            drawn->farthest = Buffer<float>(device, tiles, "farthest depths");
            ReadyKernel ready;
            ready.run = [drawn] { drawn->pass.run(drawn->visible, drawn->camera, drawn->farthest); };
            ready.error = [drawn, columns, width] {
              const std::vector<float> found = drawn->farthest.read();
              double largest = 0;
              for (std::size_t tile = 0; tile < found.size(); ++tile) {
                const std::size_t last = std::min((tile % columns + 1) * FARTHEST_TILE, width) - 1;
                const double error = std::abs(double(found[tile]) - double(depth_in_row(last)));
                largest = std::isfinite(error) ? std::max(largest, error) : HUGE_VAL;
              }
              return largest;
            };
            ready.items = static_cast<double>(width * height);
            return ready;
          }};
}

}  // namespace understory
