// The farthest depth of each tile of an image by looking at every pixel; any size of tile.
#pragma once
#include <algorithm>
#include <vector>

namespace understory::reference {

/// `depth`: m, infinite where nothing is; row by row, as is the result.
inline std::vector<float> farthest_depth(const std::vector<float>& depth, int width, int tile) {
  const int height = static_cast<int>(depth.size()) / width, columns = (width + tile - 1) / tile;
  std::vector<float> farthest(static_cast<std::size_t>(columns * ((height + tile - 1) / tile)), 0.0f);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      float& of_tile = farthest[static_cast<std::size_t>(y / tile * columns + x / tile)];
      of_tile = std::max(of_tile, depth[static_cast<std::size_t>(y * width + x)]);
    }
  return farthest;
}

}  // namespace understory::reference
