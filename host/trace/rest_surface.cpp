#include "host/trace/rest_surface.hpp"

#include <algorithm>

namespace understory {
namespace {

std::vector<glm::vec3> rest_positions(const VertexBlocks& vertices) {
  std::vector<glm::vec3> positions;
  positions.reserve(vertices.x.size());
  for (std::size_t i = 0; i < vertices.x.size(); ++i)
    positions.emplace_back(vertices.x[i], vertices.y[i], vertices.z[i]);
  return positions;
}

glm::vec3 area_vector(glm::vec3 a, glm::vec3 b, glm::vec3 c) { return 0.5f * glm::cross(b - a, c - a); }

}  // namespace

RestSurface::RestSurface(const Prototype& prototype)
    : positions_(rest_positions(prototype.vertices)),
      triangles_(prototype.triangles),
      // Two hundred times the rounding error of a coordinate as large as the plant.
      offset_(1e-5f * glm::length(prototype.high - prototype.low)),
      tracer_(positions_, triangles_) {}

float RestSurface::area(std::size_t triangle) const {
  return glm::length(area_vector(corner(triangle, 0), corner(triangle, 1), corner(triangle, 2)));
}

glm::vec3 RestSurface::normal(std::size_t triangle) const {
  const glm::vec3 n = area_vector(corner(triangle, 0), corner(triangle, 1), corner(triangle, 2));
  return n / std::max(glm::length(n), 1e-30f);
}

void RestSurface::open(std::span<const SurfacePoint> points, std::span<const glm::vec3> directions,
                       std::span<std::uint8_t> out) const {
  std::vector<Ray> rays(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    rays[i].origin = points[i].position + offset_ * points[i].normal;
    rays[i].direction = directions[i];
  }
  tracer_.blocked(rays, out);
  for (std::uint8_t& blocked : out) blocked = blocked ? 0 : 1;
}

}  // namespace understory
