// The smallest sphere, by an active set: the farthest point joins the few that hold the sphere, until none is outside.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "sim/crown.hpp"

namespace understory {
namespace {

using Points = std::vector<glm::dvec3>;

/// The sphere through 1 to 4 points with its centre in their affine hull; none if they are affinely dependent.
std::optional<Sphere> circumscribed(const Points& points) {
  const glm::dvec3 origin = points.front();
  const std::size_t n = points.size() - 1;
  // The centre is origin + sum of w_j e_j with 2 e_i . (sum of w_j e_j) = e_i . e_i: Gaussian elimination.
  std::array<std::array<double, 4>, 3> rows{};
  for (std::size_t i = 0; i < n; ++i) {
    const glm::dvec3 edge = points[i + 1] - origin;
    for (std::size_t j = 0; j < n; ++j) rows[i][j] = 2 * glm::dot(edge, points[j + 1] - origin);
    rows[i][n] = glm::dot(edge, edge);
  }
  for (std::size_t pivot = 0; pivot < n; ++pivot) {
    std::size_t best = pivot;
    for (std::size_t i = pivot; i < n; ++i) {
      if (std::abs(rows[i][pivot]) > std::abs(rows[best][pivot])) best = i;
    }
    std::swap(rows[pivot], rows[best]);
    if (std::abs(rows[pivot][pivot]) < 1e-12 * glm::dot(points.back() - origin, points.back() - origin)) return {};
    for (std::size_t i = 0; i < n; ++i) {
      const double factor = i == pivot ? 0 : rows[i][pivot] / rows[pivot][pivot];
      for (std::size_t j = 0; j <= n; ++j) rows[i][j] -= factor * rows[pivot][j];
    }
  }
  Sphere sphere{origin, 0};
  for (std::size_t i = 0; i < n; ++i) sphere.centre += rows[i][n] / rows[i][i] * (points[i + 1] - origin);
  sphere.radius = glm::distance(sphere.centre, origin);
  return sphere;
}

/// The smallest sphere around at most 5 points, and the points on it: the smallest of all circumscribed ones that hold
/// every point.
Sphere smallest_of_few(const Points& points, Points& support) {
  Sphere best{points.front(), std::numeric_limits<double>::infinity()};
  for (unsigned subset = 1; subset < 1u << points.size(); ++subset) {
    Points chosen;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (subset >> i & 1u) chosen.push_back(points[i]);
    }
    if (chosen.size() > 4) continue;
    const std::optional<Sphere> sphere = circumscribed(chosen);
    if (!sphere || sphere->radius >= best.radius) continue;
    const bool holds = std::all_of(points.begin(), points.end(), [&](const glm::dvec3& point) {
      return glm::distance(point, sphere->centre) <= sphere->radius * (1 + 1e-10) + 1e-300;
    });
    if (holds) best = *sphere, support = chosen;
  }
  return best;
}

}  // namespace

Sphere smallest_sphere(const std::vector<glm::vec3>& float_points) {
  if (float_points.empty()) return {};
  const Points points(float_points.begin(), float_points.end());
  Points support{points.front()};
  Sphere sphere{points.front(), 0};
  // Gaertner 1999, "Fast and robust smallest enclosing balls": the farthest point joins the support; the radius grows
  // with every step, so the loop ends. The bound only guards against rounding.
  for (int step = 0; step < 1000; ++step) {
    std::size_t far = 0;
    double farthest = -1;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const glm::dvec3 offset = points[i] - sphere.centre;
      const double squared = glm::dot(offset, offset);
      if (squared > farthest) farthest = squared, far = i;
    }
    farthest = std::sqrt(farthest);
    if (farthest <= sphere.radius * (1 + 1e-9)) break;
    Points candidates = support;
    candidates.push_back(points[far]);
    const Sphere grown = smallest_of_few(candidates, support);
    if (!(grown.radius > sphere.radius) || std::isinf(grown.radius)) {
      sphere.radius = farthest;
      break;
    }
    sphere = grown;
  }
  return sphere;
}

}  // namespace understory
