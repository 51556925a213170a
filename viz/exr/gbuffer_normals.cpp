#include "viz/exr/gbuffer_normals.hpp"

#include <limits>

namespace understory {

std::array<Plane, 3> normals_from_positions(int width, int height, const std::array<Plane, 3>& position,
                                            const std::vector<std::uint8_t>& surface, glm::dvec3 eye) {
  const auto index = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  };
  const auto point = [&](std::size_t i) { return glm::dvec3(position[0][i], position[1][i], position[2][i]); };
  const auto step = [&](int x, int y, int right, int down) {
    glm::dvec3 best(0);
    double least = std::numeric_limits<double>::infinity();
    for (const int side : {-1, 1}) {
      const int there_x = x + side * right, there_y = y + side * down;
      if (there_x < 0 || there_y < 0 || there_x >= width || there_y >= height || !surface[index(there_x, there_y)])
        continue;
      const glm::dvec3 way = point(index(there_x, there_y)) - point(index(x, y));
      if (glm::length(way) >= least) continue;
      least = glm::length(way);
      best = static_cast<double>(side) * way;
    }
    return best;
  };
  std::array<Plane, 3> normal;
  for (Plane& plane : normal) plane.assign(surface.size(), 0.0f);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t i = index(x, y);
      if (surface[i] == 0) continue;
      glm::dvec3 n = glm::cross(step(x, y, 1, 0), step(x, y, 0, 1));
      if (!(glm::length(n) > 0)) n = eye - point(i);
      n = glm::normalize(n);
      for (int axis = 0; axis < 3; ++axis) normal[static_cast<std::size_t>(axis)][i] = static_cast<float>(n[axis]);
    }
  return normal;
}

}  // namespace understory
