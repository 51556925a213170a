// What the cases of posing share: planes on the device, and how far posed vertices are from where they should be.
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "host/passes/geometry.hpp"

namespace understory {

template <typename T>
Buffer<T> uploaded(Device& device, const std::vector<T>& values, const char* what) {
  return Buffer<T>(device, std::span<const T>(values), what);
}

/// Largest distance between posed vertices and where they should be; every 97th.
inline double largest_offset(const PosedVertices& posed, const std::function<glm::dvec3(std::size_t)>& expected) {
  const std::vector<std::array<float, 4>> points = posed.points.read();
  double largest = 0;
  for (std::size_t i = 0; i < points.size(); i += 97) {
    const double offset = glm::distance(glm::dvec3(points[i][0], points[i][1], points[i][2]), expected(i));
    largest = std::isfinite(offset) ? std::max(largest, offset) : HUGE_VAL;
  }
  return largest;
}

}  // namespace understory
