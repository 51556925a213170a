// Greedy matching over the triangles around each vertex.
#include "host/trace/quads.hpp"

#include <optional>

namespace understory {
namespace {

using Corners = std::span<const std::uint32_t>;

/// Triangles around each vertex: those of vertex v are triangle[first[v]] .. triangle[first[v + 1] - 1], rising.
struct VertexTriangles {
  std::vector<std::uint32_t> first, triangle;

  VertexTriangles(std::size_t vertex_count, Corners corners) : first(vertex_count + 1, 0), triangle(corners.size()) {
    for (const std::uint32_t v : corners) ++first[v + 1];
    for (std::size_t v = 0; v < vertex_count; ++v) first[v + 1] += first[v];
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::size_t i = 0; i < corners.size(); ++i) triangle[next[corners[i]]++] = static_cast<std::uint32_t>(i / 3);
  }
};

/// The corner of triangle `t` that is off its edge from `a` to `b`; nothing if it has no such edge.
std::optional<std::uint32_t> apex_over(Corners corners, std::uint32_t t, std::uint32_t a, std::uint32_t b) {
  const std::uint32_t* c = &corners[3 * std::size_t{t}];
  for (int k = 0; k < 3; ++k)
    if (c[k] == a && c[(k + 1) % 3] == b) return c[(k + 2) % 3];
  return std::nullopt;
}

}  // namespace

QuadMesh pair_triangles(std::size_t vertex_count, std::span<const std::uint32_t> triangles) {
  const auto count = static_cast<std::uint32_t>(triangles.size() / 3);
  const Corners corners = triangles.first(3 * std::size_t{count});
  const VertexTriangles around(vertex_count, corners);
  std::vector<bool> taken(count, false);
  QuadMesh mesh;
  const auto find_partner = [&](std::uint32_t t) {
    const std::uint32_t* c = &corners[3 * std::size_t{t}];
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = c[k], b = c[(k + 1) % 3];
      for (std::uint32_t i = around.first[a]; i < around.first[a + 1]; ++i) {
        const std::uint32_t other = around.triangle[i];
        if (other <= t || taken[other]) continue;
        const std::optional<std::uint32_t> apex = apex_over(corners, other, b, a);
        if (!apex) continue;
        // First half (v0, v1, v3) = (apex of t, a, b), second (v2, v3, v1) = (apex of other, b, a).
        mesh.corners.push_back({c[(k + 2) % 3], a, *apex, b});
        mesh.triangles.push_back({t, other});
        taken[other] = true;
        return true;
      }
    }
    return false;
  };
  for (std::uint32_t t = 0; t < count; ++t) {
    if (taken[t] || find_partner(t)) continue;
    const std::uint32_t* c = &corners[3 * std::size_t{t}];
    mesh.corners.push_back({c[0], c[1], c[2], c[2]});
    mesh.triangles.push_back({t, t});
  }
  return mesh;
}

}  // namespace understory
