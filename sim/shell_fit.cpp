// Shells of least volume, by active sets: solve for a few points, add those that stick out most, until none does.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "sim/crown.hpp"

namespace understory {
namespace {

using Points = std::vector<glm::dvec3>;

Points widened(const std::vector<glm::vec3>& points) {
  Points wide;
  wide.reserve(points.size());
  for (glm::vec3 point : points) wide.emplace_back(point);
  return wide;
}

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

/// A quadratic form and centre: points with (p - c)^T shape (p - c) <= 1.
struct QuadricShell {
  glm::dvec3 centre{0};
  glm::dmat3 shape{1};
  double at(const glm::dvec3& point) const { return glm::dot(point - centre, shape * (point - centre)); }
};

/// Khachiyan's ascent with Todd and Yildirim's away steps (2007, "On Khachiyan's algorithm for the computation of
/// minimum-volume enclosing ellipsoids", Discrete Appl. Math. 155:1731), on lifted points q = (p, 1).
QuadricShell khachiyan(const Points& points, std::vector<double>& weights, double tolerance) {
  constexpr double dimension = 4;  // of the lifted points
  constexpr int most_steps = 20'000;
  std::vector<double> distance(points.size());
  for (int step = 0; step < most_steps; ++step) {
    glm::dmat4 moment(0);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const glm::dvec4 lifted(points[i], 1);
      moment += weights[i] * glm::outerProduct(lifted, lifted);
    }
    const glm::dmat4 inverse = glm::inverse(moment);
    std::size_t far = 0, near = points.size();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const glm::dvec4 lifted(points[i], 1);
      distance[i] = glm::dot(lifted, inverse * lifted);
      if (distance[i] > distance[far]) far = i;
      if (weights[i] > 0 && (near == points.size() || distance[i] < distance[near])) near = i;
    }
    const double above = distance[far] / dimension - 1, below = 1 - distance[near] / dimension;
    if (std::max(above, below) < tolerance) break;
    const std::size_t chosen = above >= below ? far : near;
    double move = (distance[chosen] - dimension) / (dimension * (distance[chosen] - 1));
    move = std::max(move, -weights[chosen] / (1 - weights[chosen]));  // a weight never falls below 0
    for (double& weight : weights) weight *= 1 - move;
    weights[chosen] = std::max(0.0, weights[chosen] + move);
  }
  QuadricShell shell;
  for (std::size_t i = 0; i < points.size(); ++i) shell.centre += weights[i] * points[i];
  glm::dmat3 covariance(0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::dvec3 offset = points[i] - shell.centre;
    covariance += weights[i] * glm::outerProduct(offset, offset);
  }
  shell.shape = glm::inverse(covariance) / 3.0;
  return shell;
}

/// Directions that start the active set and later spread its additions: axes, edges and corners of a cube.
std::vector<glm::dvec3> cube_directions() {
  std::vector<glm::dvec3> directions;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (x != 0 || y != 0 || z != 0) directions.push_back(glm::normalize(glm::dvec3(x, y, z)));
  return directions;
}

/// The box's middle thickened: keeps a flat or linear set from an ellipsoid without volume.
Points thickening(const Points& points) {
  glm::dvec3 low = points.front(), high = points.front();
  for (const glm::dvec3& point : points) low = glm::min(low, point), high = glm::max(high, point);
  const glm::dvec3 middle = 0.5 * (low + high);
  const double half = 0.005 * glm::distance(low, high);
  Points added;
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 offset(0);
    offset[axis] = half;
    added.push_back(middle + offset);
    added.push_back(middle - offset);
  }
  return added;
}

/// Adds to `active` the point that sticks out most in each octant of the shell's own axes; false if none does.
bool add_outliers(const Points& points, const QuadricShell& shell, double tolerance, Points& active) {
  std::array<double, 8> worst;
  std::array<std::size_t, 8> which{};
  worst.fill(1 + tolerance);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::dvec3 offset = points[i] - shell.centre;
    const double value = shell.at(points[i]);
    if (value <= 1 + tolerance) continue;
    const std::size_t octant = (offset.x > 0 ? 1u : 0u) + (offset.y > 0 ? 2u : 0u) + (offset.z > 0 ? 4u : 0u);
    if (value > worst[octant]) worst[octant] = value, which[octant] = i;
  }
  bool any = false;
  for (std::size_t octant = 0; octant < 8; ++octant) {
    if (worst[octant] > 1 + tolerance) active.push_back(points[which[octant]]), any = true;
  }
  return any;
}

/// Eigenvectors and eigenvalues of a symmetric matrix by Jacobi rotations: matrix = axes diag(values) axes^T.
void diagonalise(glm::dmat3 matrix, glm::dmat3& axes, glm::dvec3& values) {
  axes = glm::dmat3(1);
  for (int sweep = 0; sweep < 30; ++sweep) {
    for (int p = 0; p < 2; ++p) {
      for (int q = p + 1; q < 3; ++q) {
        if (matrix[p][q] == 0) continue;
        const double angle = 0.5 * std::atan2(2 * matrix[p][q], matrix[q][q] - matrix[p][p]);
        glm::dmat3 rotation(1);
        rotation[p][p] = rotation[q][q] = std::cos(angle);
        rotation[q][p] = std::sin(angle);
        rotation[p][q] = -std::sin(angle);
        matrix = glm::transpose(rotation) * matrix * rotation;
        axes = axes * rotation;
      }
    }
  }
  values = {matrix[0][0], matrix[1][1], matrix[2][2]};
}

Ellipsoid from_quadric(const QuadricShell& shell) {
  glm::dmat3 axes;
  glm::dvec3 values;
  diagonalise(shell.shape, axes, values);
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) { return values[a] < values[b]; });
  Ellipsoid ellipsoid;
  ellipsoid.centre = shell.centre;
  for (int i = 0; i < 3; ++i) {
    ellipsoid.axes[i] = glm::normalize(axes[order[static_cast<std::size_t>(i)]]);
    ellipsoid.radii[i] = 1 / std::sqrt(values[order[static_cast<std::size_t>(i)]]);
  }
  if (glm::determinant(ellipsoid.axes) < 0) ellipsoid.axes[2] = -ellipsoid.axes[2];
  return ellipsoid;
}

}  // namespace

Sphere smallest_sphere(const std::vector<glm::vec3>& float_points) {
  if (float_points.empty()) return {};
  const Points points = widened(float_points);
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

Ellipsoid smallest_ellipsoid(const std::vector<glm::vec3>& float_points) {
  if (float_points.empty()) return {};
  const Points points = widened(float_points);
  constexpr double tolerance = 2e-4;  // of the quadratic form; 3/2 of it in volume, for each of the two loops
  Points active = thickening(points);
  for (const glm::dvec3& direction : cube_directions()) {
    active.push_back(*std::max_element(points.begin(), points.end(), [&](const glm::dvec3& a, const glm::dvec3& b) {
      return glm::dot(a, direction) < glm::dot(b, direction);
    }));
  }
  QuadricShell shell;
  for (int round = 0; round < 200; ++round) {
    std::vector<double> weights(active.size(), 1 / static_cast<double>(active.size()));
    shell = khachiyan(active, weights, tolerance);
    Points kept;  // points without weight are inside: they would only slow the next round
    for (std::size_t i = 0; i < active.size(); ++i) {
      if (weights[i] > 0) kept.push_back(active[i]);
    }
    active = std::move(kept);
    if (!add_outliers(points, shell, tolerance, active)) break;
  }
  double worst = 1;  // the last step to a shell that really holds every point
  for (const glm::dvec3& point : points) worst = std::max(worst, shell.at(point));
  shell.shape /= worst;
  return from_quadric(shell);
}

}  // namespace understory
