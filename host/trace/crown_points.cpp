#include "host/trace/crown_points.hpp"

#include <algorithm>
#include <cmath>

#include "host/trace/directions.hpp"
#include "host/trace/truth.hpp"

namespace understory {
namespace {

glm::vec3 vertex(const Prototype& prototype, std::uint32_t index) {
  const VertexBlocks& blocks = prototype.vertices;
  return {blocks.x[index], blocks.y[index], blocks.z[index]};
}

}  // namespace

Tracer trace_prototype(const Prototype& prototype) {
  std::vector<glm::vec3> vertices;
  for (std::uint32_t i = 0; i < prototype.vertices.x.size(); ++i) vertices.push_back(vertex(prototype, i));
  return Tracer(vertices, prototype.triangles);
}

std::vector<CrownLine> random_lines(const Sphere& sphere, std::size_t count, std::uint32_t seed) {
  std::vector<CrownLine> lines;
  const auto radius = static_cast<float>(sphere.radius);
  for (std::size_t i = 0; i < count; ++i) {
    const auto index = static_cast<std::uint32_t>(i);
    const glm::vec3 direction = uniform_sphere(scrambled_sobol(index, seed));
    // The foot of a cosine-weighted direction is uniform on the disc; the rest of it is half the chord.
    const glm::vec3 foot = cosine_hemisphere(scrambled_sobol(index, seed ^ 0x51ed270bu));
    const glm::mat3 frame = frame_about(direction);
    const glm::vec3 start = frame * glm::vec3(foot.x, foot.y, -foot.z);
    lines.push_back({glm::vec3(sphere.centre) + radius * start, direction, 2 * radius * foot.z});
  }
  return lines;
}

CrownPoints seen_points(const Tracer& tracer, const Prototype& prototype, std::size_t count, int rays,
                        std::uint32_t seed) {
  constexpr std::uint32_t most_batches = 32;
  const Sphere around{0.5 * glm::dvec3(prototype.low + prototype.high),
                      0.5 * double(glm::distance(prototype.low, prototype.high))};
  CrownPoints points;
  for (std::uint32_t batch = 0; batch < most_batches && points.positions.size() < count; ++batch) {
    std::vector<Ray> sent;
    for (const CrownLine& line : random_lines(around, count, seed + 0x9e3779b9u * batch))
      sent.push_back({line.origin, 0, line.direction, line.length});
    std::vector<Hit> hits(sent.size());
    tracer.nearest(sent, hits);
    for (std::size_t i = 0; i < hits.size() && points.positions.size() < count; ++i) {
      if (hits[i].triangle == no_hit) continue;
      const auto corner = [&](std::uint32_t k) {
        return vertex(prototype, prototype.triangles[3 * hits[i].triangle + k]);
      };
      const glm::vec3 cross = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
      if (!(glm::dot(cross, cross) > 0)) continue;
      const glm::vec3 normal = glm::normalize(cross);
      points.positions.push_back(sent[i].origin + hits[i].distance * sent[i].direction);
      points.normals.push_back(glm::dot(normal, sent[i].direction) < 0 ? normal : -normal);
    }
  }
  TruthOptions options;
  options.rays = rays;
  options.seed = seed;
  options.sky = Sky::sphere;
  points.visibility = trace_truth(tracer, points.positions, points.normals, options).visibility;
  return points;
}

std::vector<std::int8_t> blocked_within(const Tracer& tracer, const std::vector<CrownLine>& lines,
                                        const Sphere& sphere) {
  std::vector<std::int8_t> result(lines.size(), -1);
  std::vector<Ray> rays;
  std::vector<std::size_t> of;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const glm::dvec3 offset = glm::dvec3(lines[i].origin) - sphere.centre, direction(lines[i].direction);
    const double b = glm::dot(offset, direction), c = glm::dot(offset, offset) - sphere.radius * sphere.radius;
    if (b * b - c <= 0) continue;
    const double half = std::sqrt(b * b - c), enter = std::max(-b - half, 0.0), leave = -b + half;
    if (leave <= enter) continue;
    rays.push_back({lines[i].origin, static_cast<float>(enter), lines[i].direction, static_cast<float>(leave)});
    of.push_back(i);
  }
  std::vector<std::uint8_t> blocked(rays.size());
  tracer.blocked(rays, blocked);
  for (std::size_t i = 0; i < rays.size(); ++i) result[of[i]] = static_cast<std::int8_t>(blocked[i]);
  return result;
}

}  // namespace understory
