// Bare triangles for tests that trace: rectangles, spheres, squares scattered in space.
#pragma once
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "host/trace/directions.hpp"

namespace understory {

struct Triangles {
  std::vector<glm::vec3> vertices;
  std::vector<std::uint32_t> triangles;  // 3 per triangle
};

inline void add_rectangle(Triangles& mesh, glm::vec3 corner, glm::vec3 edge, glm::vec3 other_edge) {
  const auto next = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {corner, corner + edge, corner + edge + other_edge, corner + other_edge});
  mesh.triangles.insert(mesh.triangles.end(), {next, next + 1, next + 2, next, next + 2, next + 3});
}

inline Triangles rectangle(glm::vec3 corner, glm::vec3 edge, glm::vec3 other_edge) {
  Triangles mesh;
  add_rectangle(mesh, corner, edge, other_edge);
  return mesh;
}

inline void add_square(Triangles& mesh, glm::vec3 centre, glm::vec3 normal, float edge) {
  const glm::mat3 frame = frame_about(normal);
  add_rectangle(mesh, centre - 0.5f * edge * (frame[0] + frame[1]), edge * frame[0], edge * frame[1]);
}

/// Closed, of `rings` by 2 `rings` cells.
inline Triangles sphere(std::uint32_t rings, glm::vec3 centre, float radius) {
  Triangles mesh;
  const std::uint32_t columns = 2 * rings;
  for (std::uint32_t i = 0; i <= rings; ++i)
    for (std::uint32_t j = 0; j < columns; ++j) {
      const double polar = M_PI * i / rings, azimuth = 2 * M_PI * j / columns;
      mesh.vertices.push_back(centre + radius * glm::vec3(std::sin(polar) * std::cos(azimuth),
                                                          std::sin(polar) * std::sin(azimuth), std::cos(polar)));
    }
  for (std::uint32_t i = 0; i < rings; ++i)
    for (std::uint32_t j = 0; j < columns; ++j) {
      const std::uint32_t a = i * columns + j, b = i * columns + (j + 1) % columns;
      mesh.triangles.insert(mesh.triangles.end(), {a, a + columns, b + columns, a, b + columns, b});
    }
  return mesh;
}

}  // namespace understory
