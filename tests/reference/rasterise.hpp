// What each pixel sees, the slow way: a ray through every pixel's sample against every triangle, in double.
#pragma once
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "kernels/shared/records.h"

namespace understory::reference {

struct Hit {
  double depth = std::numeric_limits<double>::infinity();  // along the camera's forward axis, m
  std::uint32_t triangle = 0xffffffffu;                    // none
};

inline glm::dvec3 axis(const float (&a)[4]) { return {a[0], a[1], a[2]}; }

/// Ray direction through the sample of pixel (x, y); its forward component is 1.
inline glm::dvec3 pixel_ray(const CameraView& camera, int x, int y) {
  const double right = (x + 0.5 - camera.centre_x) / camera.focal, down = (y + 0.5 - camera.centre_y) / camera.focal;
  return right * axis(camera.right) + down * axis(camera.down) + axis(camera.forward);
}

/// Moeller and Trumbore 1997. Barycentrics (u, v) and ray parameter t; false when the ray is parallel.
inline bool intersect(glm::dvec3 ray, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, double& u, double& v, double& t) {
  const glm::dvec3 e1 = b - a, e2 = c - a, p = glm::cross(ray, e2);
  const double determinant = glm::dot(e1, p);
  if (determinant == 0) return false;
  u = glm::dot(-a, p) / determinant;
  const glm::dvec3 q = glm::cross(-a, e1);
  v = glm::dot(ray, q) / determinant;
  t = glm::dot(e2, q) / determinant;
  return true;
}

/// `vertices`: camera-relative; `triangles`: 3 indices each. Nearest hit beyond the near plane.
inline Hit trace_pixel(const CameraView& camera, const std::vector<glm::dvec3>& vertices,
                       const std::vector<std::uint32_t>& triangles, int x, int y) {
  Hit nearest;
  const glm::dvec3 ray = pixel_ray(camera, x, y);
  for (std::size_t i = 0; i < triangles.size(); i += 3) {
    double u, v, t;
    const glm::dvec3 a = vertices[triangles[i]], b = vertices[triangles[i + 1]], c = vertices[triangles[i + 2]];
    if (!intersect(ray, a, b, c, u, v, t) || u < 0 || v < 0 || u + v > 1) continue;
    if (t <= camera.near_plane || t >= nearest.depth) continue;
    nearest.depth = t;
    nearest.triangle = static_cast<std::uint32_t>(i / 3);
  }
  return nearest;
}

}  // namespace understory::reference
