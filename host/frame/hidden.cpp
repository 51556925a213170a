#include "host/frame/hidden.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/shared/farthest_depth.h"

namespace understory {
namespace {

double along(const float (&axis)[4], const glm::dvec3& p) {
  return double(axis[0]) * p.x + double(axis[1]) * p.y + double(axis[2]) * p.z;
}

struct Tiles {
  int first, last;
};

/// Tiles along one axis that [low, high] metres sideways, from `nearest` to `farthest` metres ahead, may fall on.
Tiles tiles_of(double low, double high, double nearest, double farthest, float focal, float centre, int pixels) {
  const double left = low / (low < 0 ? nearest : farthest) * double(focal) + double(centre);
  const double right = high / (high > 0 ? nearest : farthest) * double(focal) + double(centre);
  // A pixel more on both sides: corners snap. Clamped before they become whole numbers.
  const double most = pixels - 1;
  return {static_cast<int>(std::clamp(left - 1, 0.0, most)) / static_cast<int>(FARTHEST_TILE),
          static_cast<int>(std::clamp(right + 1, 0.0, most)) / static_cast<int>(FARTHEST_TILE)};
}

}  // namespace

bool DrawnDepth::hides() const {
  return std::any_of(farthest.begin(), farthest.end(), [](float depth) { return std::isfinite(depth); });
}

bool is_hidden(const DrawnDepth& drawn, const glm::dvec3& centre, double radius) {
  if (drawn.farthest.empty()) return false;
  const CameraView& camera = drawn.camera;
  radius = 1.0001 * radius + 1e-4 * glm::length(centre);  // poses and depths on the device are in float
  const double x = along(camera.right, centre), y = along(camera.down, centre), z = along(camera.forward, centre);
  const double nearest = z - radius, farthest = z + radius;
  if (!(nearest > double(camera.near_plane))) return false;
  const Tiles columns =
      tiles_of(x - radius, x + radius, nearest, farthest, camera.focal, camera.centre_x, camera.width);
  const Tiles rows = tiles_of(y - radius, y + radius, nearest, farthest, camera.focal, camera.centre_y, camera.height);
  const int row_length = static_cast<int>(farthest_tiles(static_cast<std::uint32_t>(camera.width)));
  for (int row = rows.first; row <= rows.last; ++row)
    for (int column = columns.first; column <= columns.last; ++column)
      if (!(double(drawn.farthest[static_cast<std::size_t>(row * row_length + column)]) < nearest)) return false;
  return true;
}

}  // namespace understory
