// Structural similarity of two images (Wang, Bovik, Sheikh, Simoncelli 2004, "Image quality assessment"). VTK 9.1 has
// none yet.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace understory {

/// The index of every pixel, in [-1, 1], 1 for equal images: 11 x 11 Gaussian window of deviation 1.5 pixels, cut off
/// and renormalised at the border, K1 = 0.01, K2 = 0.03, range 1. Row-major; throws Error(unexpected) unless both have
/// width x height values.
std::vector<float> ssim_map(int width, int height, std::span<const float> a, std::span<const float> b);

}  // namespace understory
