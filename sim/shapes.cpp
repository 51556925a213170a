#include "sim/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace understory {
namespace {

constexpr int meridians = 48, rings = 24;  // 7.5 degrees a facet

/// Upper pole, rows of `meridians` vertices from top to bottom, lower pole. A row is (radius in x, in y, height).
RawMesh::Part stack_ellipses(const std::vector<glm::dvec3>& rows, double top, double bottom) {
  RawMesh::Part part;
  part.surface = SurfaceClass::occluder;
  part.positions.emplace_back(0, 0, top);
  for (const glm::dvec3& row : rows)
    for (int m = 0; m < meridians; ++m) {
      const double azimuth = 2 * std::numbers::pi * m / meridians;
      part.positions.emplace_back(row.x * std::cos(azimuth), row.y * std::sin(azimuth), row.z);
    }
  part.positions.emplace_back(0, 0, bottom);
  const auto last = static_cast<std::uint32_t>(part.positions.size() - 1);
  const auto vertex = [](std::size_t row, int m) {
    return static_cast<std::uint32_t>(1 + row * meridians + m % meridians);
  };
  const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    part.triangles.insert(part.triangles.end(), {a, b, c});
  };
  for (int m = 0; m < meridians; ++m) {
    triangle(0, vertex(0, m), vertex(0, m + 1));
    for (std::size_t row = 0; row + 1 < rows.size(); ++row) {
      triangle(vertex(row, m), vertex(row + 1, m), vertex(row + 1, m + 1));
      triangle(vertex(row, m), vertex(row + 1, m + 1), vertex(row, m + 1));
    }
    triangle(vertex(rows.size() - 1, m), last, vertex(rows.size() - 1, m + 1));
  }
  return part;
}

/// Two half ellipsoids of the given radii, their equators at z = +-apart with a cylinder between.
RawMesh::Part round_part(glm::dvec3 radii, double apart) {
  std::vector<glm::dvec3> rows;
  for (int ring = 1; ring < rings; ++ring) {
    const double polar = std::numbers::pi * ring / rings;
    const glm::dvec3 row = radii * glm::dvec3(std::sin(polar), std::sin(polar), std::cos(polar));
    if (2 * ring <= rings) rows.push_back(row + glm::dvec3(0, 0, apart));
    if (2 * ring > rings || (2 * ring == rings && apart > 0)) rows.push_back(row - glm::dvec3(0, 0, apart));
  }
  return stack_ellipses(rows, radii.z + apart, -radii.z - apart);
}

/// Area of the convex hull of points in the plane (Andrew's monotone chain). Reorders the points.
double hull_area(std::vector<glm::dvec2>& points) {
  std::sort(points.begin(), points.end(), [](auto a, auto b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  const auto turn = [](glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  };
  std::vector<glm::dvec2> hull;
  const auto add_chain = [&](auto first, auto last) {
    const std::size_t start = hull.size();
    for (auto point = first; point != last; ++point) {
      while (hull.size() >= start + 2 && turn(hull[hull.size() - 2], hull.back(), *point) <= 0) hull.pop_back();
      hull.push_back(*point);
    }
    hull.pop_back();
  };
  add_chain(points.begin(), points.end());
  add_chain(points.rbegin(), points.rend());
  double twice = 0;
  for (std::size_t i = 1; i + 1 < hull.size(); ++i) twice += turn(hull[0], hull[i], hull[i + 1]);
  return twice / 2;
}

}  // namespace

RawMesh::Part box_part(glm::dvec3 edges) {
  RawMesh::Part part;
  part.surface = SurfaceClass::occluder;
  for (int corner = 0; corner < 8; ++corner)  // bits: x, y, z
    part.positions.emplace_back(edges * (glm::dvec3(corner & 1, (corner >> 1) & 1, corner >> 2) - 0.5));
  part.triangles = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                    2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  return part;
}

RawMesh::Part ellipsoid_part(glm::dvec3 diameters) { return round_part(diameters / 2.0, 0); }

RawMesh::Part capsule_part(glm::dvec3 size) {
  const double cap = std::min((size.x + size.y) / 4, size.z / 2);
  return round_part({size.x / 2, size.y / 2, cap}, size.z / 2 - cap);
}

RawMesh::Part stacked_part(const std::vector<glm::dvec3>& sections) {
  std::vector<glm::dvec3> rows;
  for (auto section = sections.rbegin(); section != sections.rend(); ++section)
    rows.push_back(*section * glm::dvec3(0.5, 0.5, 1));
  return stack_ellipses(rows, rows.front().z, rows.back().z);
}

double mean_shadow_area(const std::vector<glm::vec3>& points) {
  if (points.size() < 3) return 0;
  constexpr int directions = 64;
  double sum = 0;
  std::vector<glm::dvec2> shadow(points.size());
  for (int i = 0; i < directions; ++i) {
    // Fibonacci lattice on a hemisphere: opposite directions cast the same shadow.
    const double z = (i + 0.5) / directions, azimuth = i * std::numbers::pi * (3 - std::sqrt(5.0));
    const double ring = std::sqrt(1 - z * z);
    const glm::dvec3 across(-std::sin(azimuth), std::cos(azimuth), 0);
    const glm::dvec3 along = glm::cross(glm::dvec3(ring * std::cos(azimuth), ring * std::sin(azimuth), z), across);
    std::transform(points.begin(), points.end(), shadow.begin(), [&](const glm::vec3& p) {
      return glm::dvec2(glm::dot(glm::dvec3(p), across), glm::dot(glm::dvec3(p), along));
    });
    sum += hull_area(shadow);
  }
  return sum / directions;
}

std::vector<Sphere> cover_with_spheres(const std::vector<glm::vec3>& points) {
  if (points.size() < 3) return {};
  glm::dvec3 low(points.front()), high = low;
  for (const glm::vec3& point : points) {
    low = glm::min(low, glm::dvec3(point));
    high = glm::max(high, glm::dvec3(point));
  }
  const glm::dvec3 edges = high - low;
  const int longest = edges.x >= edges.y && edges.x >= edges.z ? 0 : edges.y >= edges.z ? 1 : 2;
  const double across = std::sqrt(edges[(longest + 1) % 3] * edges[(longest + 2) % 3]);
  const int count = static_cast<int>(std::clamp(std::round(edges[longest] / std::max(across, 1e-9)), 1.0, 4.0));
  const double radius = std::sqrt(mean_shadow_area(points) / (std::numbers::pi * count));
  if (!(radius > 0)) return {};
  std::vector<Sphere> spheres(count, {(low + high) / 2.0, radius});
  const double reach = std::max(edges[longest] / 2 - radius, 0.0);  // outermost centres
  for (int i = 0; i < count && count > 1; ++i) spheres[i].centre[longest] += reach * (2.0 * i / (count - 1) - 1);
  return spheres;
}

}  // namespace understory
