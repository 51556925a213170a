#include "sim/mesh_shape.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

namespace understory {
namespace {

/// For each vertex the first one at the same position.
std::vector<std::uint32_t> joined(std::span<const glm::vec3> vertices) {
  std::vector<std::uint32_t> order(vertices.size()), first(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t i) { return std::array{vertices[i].x, vertices[i].y, vertices[i].z}; };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && vertices[order[i]] == vertices[order[i - 1]];
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }
  return first;
}

}  // namespace

MeshShape mesh_shape(std::span<const glm::vec3> vertices, std::span<const std::uint32_t> triangles) {
  MeshShape shape;
  const std::vector<std::uint32_t> first = joined(vertices);
  std::vector<std::uint64_t> edges;
  edges.reserve(triangles.size());
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    glm::dvec3 p[3];
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = glm::dvec3(vertices[triangles[t + k]]);
      const std::uint64_t a = first[triangles[t + k]], b = first[triangles[t + (k + 1) % 3]];
      if (a != b) edges.push_back(std::min(a, b) << 32 | std::max(a, b));
    }
    shape.volume += glm::dot(p[0], glm::cross(p[1], p[2])) / 6;
    shape.area += 0.5 * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0, next; i < edges.size(); i = next) {
    for (next = i; next < edges.size() && edges[next] == edges[i];) ++next;
    shape.open_edges += next - i != 2;
  }
  return shape;
}

}  // namespace understory
