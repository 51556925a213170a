#include "host/passes/farthest_depth.hpp"

#include "host/passes/planes.hpp"
#include "kernels/shared/farthest_depth.h"

namespace understory {

void FarthestDepthPass::run(const VisibilityBuffer& visible, const CameraView& camera, Buffer<float>& farthest) {
  const auto width = static_cast<std::uint32_t>(camera.width), height = static_cast<std::uint32_t>(camera.height);
  const std::size_t tiles = std::size_t{farthest_tiles(width)} * farthest_tiles(height);
  require_size("farthest_depth", "visible", visible.words.size(), 2 * std::size_t{width} * height);
  require_size("farthest_depth", "farthest", farthest.size(), tiles);
  kernel_.launch(tiles, 64, visible.words, width, height, farthest);
}

}  // namespace understory
