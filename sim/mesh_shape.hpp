// What a triangle mesh is as a body: closed or open, right side out or not.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

namespace understory {

struct MeshShape {
  std::size_t open_edges = 0;  // edges that do not join exactly two triangles; 0: closed
  double volume = 0;           // signed, m^3: negative when the triangles face inwards; only of meaning when closed
  double area = 0;             // of all triangles, m^2
};

/// Vertices at equal positions count as one.
MeshShape mesh_shape(std::span<const glm::vec3> vertices, std::span<const std::uint32_t> triangles);

}  // namespace understory
