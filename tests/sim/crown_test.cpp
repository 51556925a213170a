// Crown shells and constants against closed forms, brute force, and properties that a smallest shell must have.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/crown.hpp"
#include "sim/plants/species.hpp"
#include "sim/random.hpp"

namespace understory {
namespace {

using Points = std::vector<glm::vec3>;

glm::dvec3 random_direction(Random& random) {
  const double z = random.uniform(-1, 1), turn = random.uniform(0, 2 * M_PI), r = std::sqrt(1 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

Points random_cloud(std::size_t count, std::uint64_t seed) {
  Random random(seed, stream_of("cloud"));
  Points points;
  for (std::size_t i = 0; i < count; ++i) {
    points.emplace_back(random.normal(3, 1), random.normal(-2, 2), random.normal(7, 0.5));
  }
  return points;
}

Points cube_corners(float half) {
  Points points;
  for (int i = 0; i < 8; ++i) points.emplace_back(i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half);
  return points;
}

bool holds(const Ellipsoid& shell, glm::dvec3 point) {
  return glm::length(glm::transpose(shell.axes) * (point - shell.centre) / shell.radii) <= 1 + 1e-9;
}

double volume(const Ellipsoid& shell) { return shell.radii.x * shell.radii.y * shell.radii.z; }

/// The smallest of all spheres through 2 or 3 points, or 4, that holds all: tried one by one, solved by Cramer's rule.
double brute_force_radius(const Points& points) {
  double best = 1e30;
  const auto try_sphere = [&](glm::dvec3 centre, double radius) {
    if (!(radius < best)) return;
    for (glm::vec3 p : points) {
      if (glm::distance(glm::dvec3(p), centre) > radius * (1 + 1e-9)) return;
    }
    best = radius;
  };
  const auto solve = [&](glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, glm::dvec3 right) {
    const double determinant = glm::dot(a, glm::cross(b, c));
    return (right.x * glm::cross(b, c) + right.y * glm::cross(c, a) + right.z * glm::cross(a, b)) / determinant;
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const glm::dvec3 p(points[i]), e = glm::dvec3(points[j]) - p;
      try_sphere(p + 0.5 * e, 0.5 * glm::length(e));
      for (std::size_t k = 0; k < j; ++k) {
        const glm::dvec3 f = glm::dvec3(points[k]) - p;
        const glm::dvec3 flat = solve(e, f, glm::cross(e, f), {0.5 * glm::dot(e, e), 0.5 * glm::dot(f, f), 0});
        try_sphere(p + flat, glm::length(flat));
        for (std::size_t l = 0; l < k; ++l) {
          const glm::dvec3 g = glm::dvec3(points[l]) - p;
          const glm::dvec3 full = solve(e, f, g, 0.5 * glm::dvec3(glm::dot(e, e), glm::dot(f, f), glm::dot(g, g)));
          try_sphere(p + full, glm::length(full));
        }
      }
    }
  }
  return best;
}

TEST(SmallestSphere, OfACubeGoesThroughItsCorners) {
  const Sphere sphere = smallest_sphere(cube_corners(2));
  EXPECT_NEAR(sphere.radius, 2 * std::sqrt(3.0), 1e-9);
  EXPECT_LT(glm::length(sphere.centre), 1e-9);
}

TEST(SmallestSphere, OfFewOrEqualPoints) {
  EXPECT_EQ(smallest_sphere({}).radius, 0);
  EXPECT_EQ(smallest_sphere({{1, 2, 3}}).radius, 0);
  EXPECT_EQ(smallest_sphere({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}).radius, 0);
  EXPECT_NEAR(smallest_sphere({{0, 0, 0}, {2, 0, 0}, {1, 0, 0}}).radius, 1, 1e-12) << "on a line";
  EXPECT_NEAR(smallest_sphere({{0, 0, 0}, {4, 0, 0}, {2, 0.1f, 0}}).radius, 2, 1e-9)
      << "an obtuse triangle: two points";
}

TEST(SmallestSphere, IsTheSmallestOfAllThatHoldThePoints) {
  for (std::uint64_t seed = 0; seed < 25; ++seed) {
    const Points points = random_cloud(13, seed);
    EXPECT_NEAR(smallest_sphere(points).radius / brute_force_radius(points), 1, 1e-7);
  }
}

TEST(SmallestSphere, HoldsALargeCloud) {
  const Points points = random_cloud(100'003, 77);
  const Sphere sphere = smallest_sphere(points);
  int touching = 0;
  for (glm::vec3 point : points) {
    const double share = glm::distance(glm::dvec3(point), sphere.centre) / sphere.radius;
    ASSERT_LE(share, 1 + 1e-8);
    touching += share > 1 - 1e-8;
  }
  EXPECT_GE(touching, 2);
  EXPECT_LE(touching, 4);
}

TEST(SmallestEllipsoid, OfACubeIsItsSphere) {
  const Ellipsoid shell = smallest_ellipsoid(cube_corners(2));
  EXPECT_LT(glm::length(shell.centre), 1e-3);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(shell.radii[axis], 2 * std::sqrt(3.0), 2e-3);
}

TEST(SmallestEllipsoid, FindsAKnownEllipsoid) {
  const glm::dvec3 centre(300, -40, 12), radii(5, 2, 1);
  const glm::dmat3 axes(glm::normalize(glm::dvec3(1, 2, 2)), glm::normalize(glm::dvec3(2, 1, -2)),
                        glm::normalize(glm::dvec3(2, -2, 1)));
  Random random(5, stream_of("shell"));
  Points points;
  for (int i = 0; i < 20'011; ++i) points.emplace_back(centre + axes * (radii * random_direction(random)));
  const Ellipsoid shell = smallest_ellipsoid(points);
  EXPECT_LT(glm::distance(shell.centre, centre), 5e-3);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(shell.radii[axis], radii[axis], 2e-3 * radii[axis]);
    EXPECT_NEAR(std::abs(glm::dot(shell.axes[axis], axes[axis])), 1, 1e-5);
  }
}

TEST(SmallestEllipsoid, HoldsItsPointsAndFollowsAffineMaps) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Points points = random_cloud(257, seed);
    const Ellipsoid shell = smallest_ellipsoid(points);
    for (glm::vec3 point : points) ASSERT_TRUE(holds(shell, glm::dvec3(point)));
    EXPECT_LE(volume(shell), std::pow(smallest_sphere(points).radius, 3) * 1.001);
    // The smallest shell of a stretched cloud is the stretched shell: volumes scale by the determinant.
    const glm::dmat3 stretch(3, 0.5, 0, -1, 2, 0.25, 0.5, 0, 1);
    Points stretched;
    for (glm::vec3 point : points) stretched.emplace_back(stretch * glm::dvec3(point));
    EXPECT_NEAR(volume(smallest_ellipsoid(stretched)) / (volume(shell) * glm::determinant(stretch)), 1, 1.5e-3);
  }
}

TEST(SmallestEllipsoid, HasVolumeEvenAroundAFlatSet) {
  const Ellipsoid shell = smallest_ellipsoid({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {4, 4, 0}});
  EXPECT_NEAR(shell.radii.x, 2 * std::sqrt(2.0), 0.05);
  EXPECT_GT(shell.radii.z, 0.01);
  EXPECT_LT(shell.radii.z, 0.1);
  EXPECT_TRUE(std::isfinite(smallest_ellipsoid({{1, 1, 1}, {1, 1, 2}}).radii.x));
}

TEST(DiscTransmittance, IsTheMeanOverChords) {
  for (double optical_radius : {1e-5, 4.9e-4, 5.1e-4, 0.1, 1.0, 3.7, 20.0}) {
    double sum = 0;
    constexpr int rings = 200'000;
    for (int i = 0; i < rings; ++i) sum += std::exp(-2 * optical_radius * std::sqrt(1 - (i + 0.5) / rings));
    EXPECT_NEAR(disc_transmittance(optical_radius), sum / rings, 1e-6);
  }
  EXPECT_EQ(disc_transmittance(0), 1);
}

/// Small triangles, even in a sphere, of every direction: the crown for which Beer and Lambert's law holds.
Prototype random_crown(double radius, int leaves, float leaf_size) {
  RawMesh mesh;
  mesh.parts = {{"crown", "leaf", SurfaceClass::leaf, {}, {}}};
  Random random(9, stream_of("crown"));
  for (int i = 0; i < leaves; ++i) {
    const glm::vec3 at(radius * std::cbrt(random.uniform()) * random_direction(random));
    const glm::vec3 a(random_direction(random)), b(random_direction(random));
    const glm::vec3 across = glm::normalize(glm::cross(a, b));
    const std::uint32_t first = static_cast<std::uint32_t>(mesh.parts[0].positions.size());
    mesh.parts[0].positions.insert(mesh.parts[0].positions.end(), {at, at + leaf_size * a, at + leaf_size * across});
    mesh.parts[0].triangles.insert(mesh.parts[0].triangles.end(), {first, first + 1, first + 2});
  }
  SpeciesSource source;
  source.name = "crown";
  return build_species(source, 1, &mesh).prototype;
}

TEST(DeriveConstants, MatchTheEscapeProbabilityOfASphere) {
  // Isotropic leaves, even in the sphere, both sides: the mean visibility is the probability that light born evenly in
  // a sphere escapes it (Case, de Hoffmann & Placzek 1953): 3/(8 x^3) (2 x^2 - 1 + (1 + 2x) exp(-2x)), x = kR.
  const Prototype crown = random_crown(4, 20'011, 0.1f);
  const CrownConstants constants = derive_constants(crown);
  const double radius = crown.crown.sphere_radius;
  const double x = 0.5 * crown.crown.plant_area / (4 * M_PI / 3 * radius * radius * radius) * radius;
  const double escape = 3 / (8 * x * x * x) * (2 * x * x - 1 + (1 + 2 * x) * std::exp(-2 * x));
  EXPECT_NEAR(constants.mean_visibility, escape, 0.02);
  EXPECT_NEAR(constants.opacity, 1 - disc_transmittance(x), 1e-4);
}

TEST(DeriveConstants, MakeTheModelsRightOnAverage) {
  const Prototype crown = random_crown(2.5, 9'973, 0.1f);
  const CrownConstants constants = derive_constants(crown);
  // Other fragments than the ones that were fitted: even in the sphere, normals of every direction.
  Random random(4, stream_of("fragments"));
  const double radius = crown.crown.sphere_radius;
  double eq6 = 0, reeves_blau = 0;
  constexpr int fragments = 40'009;
  for (int i = 0; i < fragments; ++i) {
    const glm::dvec3 p = 2.5 * std::cbrt(random.uniform()) * random_direction(random), n = random_direction(random);
    const double s = glm::dot(p, n), h = radius - s, d2 = glm::dot(p, p) - s * s;
    eq6 += std::exp(-constants.alpha_rho * h * h / (h * h + d2) * M_PI * h * h * (3 * radius - h) / 3) / fragments;
    reeves_blau += std::exp(-constants.reeves_blau_extinction * (radius - glm::length(p))) / fragments;
  }
  EXPECT_NEAR(eq6, constants.mean_visibility, 0.02);
  EXPECT_NEAR(reeves_blau, constants.mean_visibility, 0.02);
  EXPECT_NEAR(constants.alpha_rho_ellipsoid / constants.alpha_rho, 1, 0.1) << "the ellipsoid is nearly that sphere";
}

TEST(DeriveConstants, AreZeroWithoutACrown) {
  RawMesh mesh;
  mesh.parts.push_back({"ground", "", SurfaceClass::terrain, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2}});
  const CrownConstants constants = derive_constants(rigid_prototype("ground", mesh));
  EXPECT_EQ(constants.alpha_rho, 0);
  EXPECT_EQ(constants.opacity, 0);
}

TEST(ClusterSpheres, HoldEveryPointInTheSphereOfItsNearestCluster) {
  // Three clouds far apart are found as they are.
  Points points;
  const glm::vec3 middles[] = {{0, 0, 0}, {20, 0, 3}, {0, 25, -4}};
  for (std::uint64_t i = 0; i < 3; ++i)
    for (const glm::vec3 point : random_cloud(400, i))
      points.push_back(0.3f * (point - glm::vec3(3, -2, 7)) + middles[i]);
  const std::vector<Sphere> spheres = cluster_spheres(points, 3);
  ASSERT_EQ(spheres.size(), 3u);
  for (const glm::vec3 point : points) {
    double least = 1e9;
    for (const Sphere& sphere : spheres)
      least = std::min(least, glm::distance(glm::dvec3(point), sphere.centre) / sphere.radius);
    EXPECT_LE(least, 1 + 1e-9);
  }
  for (const glm::vec3 middle : middles) {
    double least = 1e9;
    for (const Sphere& sphere : spheres) least = std::min(least, glm::distance(glm::dvec3(middle), sphere.centre));
    EXPECT_LT(least, 2);
  }
}

TEST(ClusterSpheres, AreFewerWhereThereAreFewerPlaces) {
  EXPECT_TRUE(cluster_spheres({}, 4).empty());
  EXPECT_TRUE(cluster_spheres({glm::vec3(1), glm::vec3(1)}, 4).empty());
  EXPECT_EQ(cluster_spheres(cube_corners(1), 1).size(), 1u);
  EXPECT_NEAR(cluster_spheres(cube_corners(1), 1)[0].radius, std::sqrt(3.0), 1e-6);
}

}  // namespace
}  // namespace understory
