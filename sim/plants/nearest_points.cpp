#include "sim/plants/nearest_points.hpp"

#include <algorithm>

namespace understory {

NearestPoints::NearestPoints(std::vector<Point> points)
    : points_(std::move(points)), split_axis_(points_.size()), lowest_label_(points_.size()) {
  build(0, points_.size());
}

void NearestPoints::build(std::size_t first, std::size_t last) {
  if (first >= last) return;
  glm::vec3 low = points_[first].position, high = low;
  std::uint32_t lowest = 0xffffffffu;
  for (std::size_t i = first; i < last; ++i) {
    low = glm::min(low, points_[i].position);
    high = glm::max(high, points_[i].position);
    lowest = std::min(lowest, points_[i].label);
  }
  const glm::vec3 extent = high - low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::size_t middle = first + (last - first) / 2;
  const auto at = [&](std::size_t i) { return points_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(first), at(middle), at(last),
                   [axis](const Point& a, const Point& b) { return a.position[axis] < b.position[axis]; });
  split_axis_[middle] = static_cast<std::uint8_t>(axis);
  lowest_label_[middle] = lowest;
  build(first, middle);
  build(middle + 1, last);
}

NearestPoints::Hit NearestPoints::nearest(glm::vec3 position, std::uint32_t label_limit) const {
  Hit best;
  search(0, points_.size(), position, label_limit, best);
  return best;
}

void NearestPoints::search(std::size_t first, std::size_t last, glm::vec3 position, std::uint32_t label_limit,
                           Hit& best) const {
  if (first >= last) return;
  const std::size_t middle = first + (last - first) / 2;
  if (lowest_label_[middle] >= label_limit) return;
  const Point& node = points_[middle];
  const glm::vec3 offset = node.position - position;
  const float squared = glm::dot(offset, offset);
  if (node.label < label_limit && (!best.found || squared < best.squared_distance)) best = {true, node, squared};
  const float beyond = position[split_axis_[middle]] - node.position[split_axis_[middle]];
  const bool below = beyond < 0;
  search(below ? first : middle + 1, below ? middle : last, position, label_limit, best);
  if (!best.found || beyond * beyond < best.squared_distance) {
    search(below ? middle + 1 : first, below ? last : middle, position, label_limit, best);
  }
}

}  // namespace understory
