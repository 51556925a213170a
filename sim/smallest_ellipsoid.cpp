// The smallest ellipsoid, by an active set: solve for a few points, add those that stick out most, until none does.
#include <algorithm>
#include <array>
#include <cmath>

#include "sim/crown.hpp"

namespace understory {
namespace {

using Points = std::vector<glm::dvec3>;

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

Ellipsoid smallest_ellipsoid(const std::vector<glm::vec3>& float_points) {
  if (float_points.empty()) return {};
  const Points points(float_points.begin(), float_points.end());
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
