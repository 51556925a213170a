// Surface points of a prototype at rest as pictures show them: where parallel rays from all sides arrive first.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "host/trace/directions.hpp"
#include "host/trace/rest_surface.hpp"

namespace understory {

struct SeenSurface {
  std::vector<glm::vec3> positions, normals;  // m; unit, towards the eye
  std::vector<std::uint32_t> triangles;
  std::vector<bool> front;  // the side that is seen is the counter-clockwise one
};

inline SeenSurface seen_surface(const RestSurface& surface, const Prototype& prototype, std::uint32_t rays) {
  SeenSurface seen;
  const glm::vec3 middle = 0.5f * (prototype.low + prototype.high);
  const float size = glm::length(prototype.high - prototype.low);
  for (std::uint32_t i = 0; i < rays; ++i) {
    const glm::vec3 towards = uniform_sphere(scrambled_sobol(i, 5));
    const glm::vec2 u = size * (scrambled_sobol(i, 6) - 0.5f);
    const glm::mat3 frame = frame_about(towards);
    const Ray ray{middle + u.x * frame[0] + u.y * frame[1] - 2 * size * towards, 0, towards};
    Hit hit;
    surface.tracer().nearest({&ray, 1}, {&hit, 1});
    if (hit.triangle == no_hit) continue;
    seen.positions.push_back(ray.origin + hit.distance * towards);
    seen.normals.push_back(hit.from_front ? surface.normal(hit.triangle) : -surface.normal(hit.triangle));
    seen.triangles.push_back(hit.triangle);
    seen.front.push_back(hit.from_front);
  }
  return seen;
}

}  // namespace understory
