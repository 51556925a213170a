// The blur of obscurance in double, by other means than the kernel: heights over the tangent plane from points in
// space.
#pragma once
#include <vector>

#include "tests/reference/obscurance.hpp"

namespace understory::reference {

/// One direction of the blur: `values` per pixel, the same where nothing is seen. `reach`: m over the tangent plane at
/// which a neighbour no longer counts; the outermost two count half.
inline std::vector<double> blurred(const DepthImage& image, const std::vector<double>& values, int radius, bool down,
                                   double reach) {
  std::vector<double> result = values;
  for (int y = 0; y < image.view.height; ++y)
    for (int x = 0; x < image.view.width; ++x) {
      if (std::isinf(image.depth_at(x, y))) continue;
      const glm::dvec3 normal = image.normal_at(x, y), own = pixel_ray(image.view, x, y).at(image.depth_at(x, y));
      const auto index = [&](int column, int row) { return static_cast<std::size_t>(row * image.view.width + column); };
      double sum = values[index(x, y)], weights = 1;
      for (int step = -radius; step <= radius; ++step) {
        const int column = down ? x : x + step, row = down ? y + step : y;
        if (step == 0 || column < 0 || row < 0 || column >= image.view.width || row >= image.view.height) continue;
        if (std::isinf(image.depth_at(column, row))) continue;
        const glm::dvec3 there = pixel_ray(image.view, column, row).at(image.depth_at(column, row));
        const double near = std::max(1 - std::abs(glm::dot(there - own, normal)) / reach, 0.0);
        const double like = std::max(glm::dot(normal, image.normal_at(column, row)), 0.0);
        const double weight = (std::abs(step) == radius ? 0.5 : 1) * near * std::pow(like, 4);
        sum += weight * values[index(column, row)];
        weights += weight;
      }
      result[index(x, y)] = std::clamp(sum / weights, 0.0, 1.0);
    }
  return result;
}

}  // namespace understory::reference
