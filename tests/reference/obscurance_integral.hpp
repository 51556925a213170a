// What obscurance's samples converge to: the share of the ball on top of a fragment's tangent plane that is in front of
// the depth plane, in double, pixel by pixel. No ball, line or point of the kernels' is in here: rays of pixels'
// centres are cut with a sphere in camera space, and a pixel stands for the volume that its rays sweep there.
#pragma once
#include <algorithm>
#include <cmath>
#include <optional>

#include "tests/reference/obscurance.hpp"

namespace understory::reference {

/// Camera z between which a ray is inside a sphere; nothing where it misses.
struct Chord {
  double from, to;
};
inline std::optional<Chord> chord_of(const PixelRay& ray, const glm::dvec3& middle, double radius) {
  const glm::dvec3 offset = ray.origin - middle;
  const double a = glm::dot(ray.direction, ray.direction), b = glm::dot(offset, ray.direction);
  const double root = b * b - a * (glm::dot(offset, offset) - radius * radius);
  if (root <= 0) return {};
  const double near = (-b - std::sqrt(root)) / a, far = (-b + std::sqrt(root)) / a;
  return Chord{std::max(near, 0.0), std::max(far, 0.0)};
}

/// Falloff `cosine`, endlessly thick. 1 where the ball is outside the image.
inline double obscurance_integral(const DepthImage& image, int x, int y, double radius) {
  const bool perspective = image.view.perspective;
  const glm::dvec3 middle = pixel_ray(image.view, x, y).at(image.depth_at(x, y)) + 0.5 * radius * image.normal_at(x, y);
  // Up to camera z, of what the rays of one pixel sweep, whose section grows like z^2; orthographic: not at all.
  const auto swept = [&](double z) { return perspective ? z * z * z / 3 : z; };
  double open = 0, all = 0;
  for (int row = 0; row < image.view.height; ++row)
    for (int column = 0; column < image.view.width; ++column) {
      const std::optional<Chord> chord = chord_of(pixel_ray(image.view, column, row), middle, 0.5 * radius);
      if (!chord) continue;
      const double end = std::clamp(image.depth_at(column, row), chord->from, chord->to);
      open += swept(end) - swept(chord->from);
      all += swept(chord->to) - swept(chord->from);
    }
  return all > 0 ? open / all : 1;
}

}  // namespace understory::reference
