// Occluder shapes: closed, outward, of the right volume; their spheres cast the shadow the body casts.
#include "sim/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

namespace understory {
namespace {

constexpr double pi = std::numbers::pi;

/// Signed volume by the divergence theorem: positive for outward winding.
double volume(const RawMesh::Part& part) {
  double six = 0;
  for (std::size_t i = 0; i < part.triangles.size(); i += 3) {
    const glm::dvec3 a(part.positions[part.triangles[i]]), b(part.positions[part.triangles[i + 1]]),
        c(part.positions[part.triangles[i + 2]]);
    six += glm::dot(a, glm::cross(b, c));
  }
  return six / 6;
}

void expect_closed(const RawMesh::Part& part) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t i = 0; i < part.triangles.size(); i += 3)
    for (int side = 0; side < 3; ++side) ++edges[{part.triangles[i + side], part.triangles[i + (side + 1) % 3]}];
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(edges.contains({edge.second, edge.first}));
  }
}

TEST(Shapes, AreClosedAndHaveTheirVolume) {
  const glm::dvec3 size{0.5, 0.9, 2.3};
  for (const auto& [part, expected, tolerance] :
       {std::tuple{box_part(size), size.x * size.y * size.z, 1e-6},
        std::tuple{ellipsoid_part(size), pi / 6 * size.x * size.y * size.z, 0.01},
        std::tuple{stacked_part({{0.4, 0.6, -1}, {0.8, 1.2, 1}}), pi / 4 * 0.24 * 2 * 7 / 3, 0.01},
        std::tuple{capsule_part({0.6, 0.6, 2}), pi * 0.09 * 1.4 + pi / 6 * 0.216, 0.01}}) {
    expect_closed(part);
    EXPECT_NEAR(volume(part) / expected, 1, tolerance);
    EXPECT_EQ(part.surface, SurfaceClass::occluder);
  }
  expect_closed(capsule_part({1, 1, 0.5}));  // shorter than wide
}

TEST(Shapes, MeanShadowIsAQuarterOfAConvexSurface) {
  EXPECT_NEAR(mean_shadow_area(box_part({1, 2, 3}).positions) / (22.0 / 4), 1, 0.01);
  EXPECT_NEAR(mean_shadow_area(ellipsoid_part({2, 2, 2}).positions) / pi, 1, 0.01);
}

TEST(Shapes, ABallIsCoveredByItself) {
  const auto spheres = cover_with_spheres(ellipsoid_part({3, 3, 3}).positions);
  ASSERT_EQ(spheres.size(), 1u);
  EXPECT_NEAR(spheres[0].radius, 1.5, 0.01);
  EXPECT_NEAR(glm::length(spheres[0].centre), 0, 1e-6);
}

TEST(Shapes, ALongBodyIsARowOfSpheresWithItsShadow) {
  const auto points = box_part({6, 1, 1}).positions;
  const auto spheres = cover_with_spheres(points);
  ASSERT_EQ(spheres.size(), 4u);
  double shadow = 0;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    shadow += pi * spheres[i].radius * spheres[i].radius;
    EXPECT_NEAR(spheres[i].centre.y, 0, 1e-6);
    EXPECT_LE(std::abs(spheres[i].centre.x) + spheres[i].radius, 3 + 1e-6);
    EXPECT_NEAR(spheres[i].centre.x, (2.0 * double(i) / 3 - 1) * (3 - spheres[i].radius), 1e-6);
  }
  EXPECT_NEAR(shadow, mean_shadow_area(points), 1e-6);
}

TEST(Shapes, NothingIsCoveredByNothing) {
  EXPECT_TRUE(cover_with_spheres({}).empty());
  EXPECT_TRUE(cover_with_spheres({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}).empty());
}

}  // namespace
}  // namespace understory
