// The ray tracer against geometry that can be worked out, a brute-force search in double, and itself in other order.
#include "host/trace/tracer.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "host/trace/directions.hpp"
#include "host/trace/quads.hpp"
#include "sim/random.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/triangles.hpp"

namespace understory {
namespace {

glm::vec3 random_point(Random& random, double half) {
  return {random.uniform(-half, half), random.uniform(-half, half), random.uniform(-half, half)};
}

/// Small triangles in the cube [-1, 1]^3, every second one joined to the one before along an edge.
Triangles random_soup(std::uint32_t count, double size) {
  Triangles soup;
  for (std::uint32_t t = 0; t < count; ++t) {
    Random random(11, stream_of("soup"), t);
    const auto next = static_cast<std::uint32_t>(soup.vertices.size());
    const glm::vec3 centre = random_point(random, 1);
    if (t % 2 == 1) {
      soup.triangles.insert(soup.triangles.end(), {next - 1, next - 2, next});
      soup.vertices.push_back(soup.vertices[next - 1] + random_point(random, size));
      continue;
    }
    for (int corner = 0; corner < 3; ++corner) soup.vertices.push_back(centre + random_point(random, size));
    soup.triangles.insert(soup.triangles.end(), {next, next + 1, next + 2});
  }
  return soup;
}

std::vector<Ray> random_rays(std::size_t count) {
  std::vector<Ray> rays(count);
  for (std::size_t i = 0; i < count; ++i) {
    Random random(12, stream_of("rays"), i);
    rays[i].origin = random_point(random, 1.2);
    rays[i].direction = uniform_sphere({float(random.uniform()), float(random.uniform())});
    if (i % 3 == 0) rays[i].farthest = static_cast<float>(random.uniform(0, 2));
  }
  return rays;
}

/// Moeller and Trumbore 1997 in double; infinity: no hit. `margin`: how far inside the triangle and the span, or how
/// far outside, in barycentric units and metres.
double distance_to(const Triangles& soup, std::size_t t, const Ray& ray, double& margin) {
  const auto corner = [&](std::size_t k) { return glm::dvec3(soup.vertices[soup.triangles[3 * t + k]]); };
  const glm::dvec3 a = corner(0), e1 = corner(1) - a, e2 = corner(2) - a, d(ray.direction),
                   s = glm::dvec3(ray.origin) - a;
  const glm::dvec3 p = glm::cross(d, e2);
  const double determinant = glm::dot(e1, p);
  const double u = glm::dot(s, p) / determinant, v = glm::dot(d, glm::cross(s, e1)) / determinant;
  const double distance = glm::dot(e2, glm::cross(s, e1)) / determinant;
  const double inside = std::min({u, v, 1 - u - v, distance - ray.nearest, ray.farthest - distance});
  margin = std::min(margin, std::abs(inside));
  return inside >= 0 ? distance : std::numeric_limits<double>::infinity();
}

std::vector<std::uint8_t> blocked(const Tracer& tracer, const std::vector<Ray>& rays) {
  std::vector<std::uint8_t> out(rays.size(), 9);
  tracer.blocked(rays, out);
  return out;
}

std::vector<Hit> nearest(const Tracer& tracer, const std::vector<Ray>& rays) {
  std::vector<Hit> out(rays.size());
  tracer.nearest(rays, out);
  return out;
}

TEST(Tracer, FindsWhatASearchThroughAllTrianglesFinds) {
  const Triangles soup = random_soup(301, 0.3);
  const Tracer tracer(soup.vertices, soup.triangles);
  const std::vector<Ray> rays = random_rays(5000);
  const auto shadow = blocked(tracer, rays);
  const auto hits = nearest(tracer, rays);
  int seen = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    double margin = 1, best = std::numeric_limits<double>::infinity();
    std::uint32_t triangle = no_hit;
    for (std::size_t t = 0; t < soup.triangles.size() / 3; ++t) {
      const double distance = distance_to(soup, t, rays[i], margin);
      if (distance < best) best = distance, triangle = static_cast<std::uint32_t>(t);
    }
    if (margin < 1e-5) continue;  // on an edge to within float
    ++seen;
    ASSERT_EQ(shadow[i] != 0, triangle != no_hit) << "ray " << i;
    ASSERT_EQ(hits[i].triangle, triangle) << "ray " << i;
    if (triangle == no_hit) continue;
    ASSERT_NEAR(hits[i].distance, best, 1e-4);
    const auto corner = [&](std::size_t k) { return glm::dvec3(soup.vertices[soup.triangles[3 * triangle + k]]); };
    const glm::dvec3 normal = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
    ASSERT_EQ(hits[i].from_front, glm::dot(normal, glm::dvec3(rays[i].direction)) < 0);
  }
  EXPECT_GT(seen, 4500);
}

TEST(Tracer, AnswersEachRayAlikeInAnyCompany) {
  const Triangles soup = random_soup(20000, 0.05);
  const Tracer tracer(soup.vertices, soup.triangles);
  const std::vector<Ray> rays = random_rays(60000);
  const auto together = blocked(tracer, rays);
  const auto hits = nearest(tracer, rays);
  std::vector<std::size_t> order(rays.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [](auto a, auto b) { return mix_bits(a) < mix_bits(b); });
  std::vector<Ray> shuffled;
  for (const std::size_t i : order) shuffled.push_back(rays[i]);
  const auto apart = blocked(tracer, shuffled);
  const auto other_hits = nearest(tracer, shuffled);
  for (std::size_t i = 0; i < order.size(); ++i) {
    ASSERT_EQ(apart[i], together[order[i]]) << "ray " << order[i];
    ASSERT_EQ(other_hits[i].triangle, hits[order[i]].triangle) << "ray " << order[i];
    ASSERT_EQ(other_hits[i].distance, hits[order[i]].distance) << "ray " << order[i];
  }
  for (std::size_t i = 0; i < rays.size(); i += 7) {
    ASSERT_EQ(blocked(tracer, {rays[i]})[0], together[i]) << "alone, ray " << i;
    ASSERT_EQ(together[i] != 0, hits[i].triangle != no_hit) << "ray " << i;
  }
}

TEST(Tracer, LetsNothingOutOfAClosedBall) {
  for (const glm::vec3 centre : {glm::vec3(0), glm::vec3(300, -200, 50)}) {
    const Triangles ball = sphere(200, centre, 1);
    const Tracer tracer(ball.vertices, ball.triangles);
    std::vector<Ray> rays(300000);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      Random random(5, stream_of("ball"), i);
      rays[i].origin = centre + random_point(random, 0.5);
      rays[i].direction = uniform_sphere(scrambled_sobol(static_cast<std::uint32_t>(i), 1));
    }
    const auto shadow = blocked(tracer, rays);
    EXPECT_LE(std::count(shadow.begin(), shadow.end(), 0), 3) << "one ray in 100,000 may slip through an edge";
  }
}

TEST(Tracer, KeepsToTheSpanOfARay) {
  const std::vector<glm::vec3> vertices = {{-1, -1, 2}, {1, -1, 2}, {1, 1, 2}, {-1, 1, 2}};
  const std::vector<std::uint32_t> triangles = {0, 1, 2, 0, 2, 3};
  const Tracer tracer(vertices, triangles);
  constexpr float endless = std::numeric_limits<float>::infinity();
  const auto from = [](float near, float far) { return Ray{{0.5f, 0.1f, 0}, near, {0, 0, 1}, far}; };
  EXPECT_EQ(blocked(tracer, {from(0, endless), from(0, 1.9f), from(2.1f, endless), from(1.9f, 2.1f), from(3, 1)}),
            (std::vector<std::uint8_t>{1, 0, 0, 1, 0}));
  const auto hits = nearest(tracer, {from(0, endless), {{-0.5f, 0.1f, 4}, 0, {0, 0, -2}, endless}});
  EXPECT_EQ(hits[0].triangle, 0u);
  EXPECT_FALSE(hits[0].from_front);
  EXPECT_FLOAT_EQ(hits[0].distance, 2);
  EXPECT_EQ(hits[1].triangle, 1u);
  EXPECT_TRUE(hits[1].from_front);
  EXPECT_FLOAT_EQ(hits[1].distance, 1) << "in units of the direction's length";
}

TEST(Tracer, HitsNothingWithRaysThatAreNone) {
  const Triangles ball = sphere(8, glm::vec3(0), 1);
  const Tracer tracer(ball.vertices, ball.triangles);
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), endless = std::numeric_limits<float>::infinity();
  const std::vector<Ray> rays = {{{nan, 0, 0}, 0, {0, 0, 1}, endless},     {{0, 0, 0}, 0, {0, nan, 1}, endless},
                                 {{0, 0, 0}, 0, {0, 0, 0}, endless},       {{0, endless, 0}, 0, {0, 0, 1}, endless},
                                 {{0, 0, 0}, nan, {0, 0, 1}, endless},     {{0, 0, 0}, 0, {0, 0, 1}, nan},
                                 {{0, 0, 0}, 0, {0, -endless, 1}, endless}};
  for (const std::uint8_t hit : blocked(tracer, rays)) EXPECT_EQ(hit, 0);
  for (const Hit& hit : nearest(tracer, rays)) EXPECT_EQ(hit.triangle, no_hit);
  EXPECT_EQ(blocked(tracer, {Ray{}})[0], 1) << "the ball is there";
}

TEST(Tracer, IsOpenWithoutTriangles) {
  const Tracer tracer({}, {});
  for (const std::uint8_t hit : blocked(tracer, random_rays(100))) EXPECT_EQ(hit, 0);
}

TEST(Tracer, RefusesIndicesOutOfRange) {
  const std::vector<glm::vec3> vertices(3);
  const std::vector<std::uint32_t> triangles = {0, 1, 3};
  EXPECT_THAT(message_of(ErrorKind::invalid_input, [&] { Tracer(vertices, triangles); }),
              testing::HasSubstr("triangle index 3"));
}

TEST(PairTriangles, KeepsEveryTriangleOnce) {
  const Triangles soup = random_soup(1001, 0.1);
  const QuadMesh mesh = pair_triangles(soup.vertices.size(), soup.triangles);
  EXPECT_EQ(mesh.corners.size(), 501u) << "500 pairs and one alone";
  std::vector<int> seen(1001, 0);
  for (std::size_t q = 0; q < mesh.corners.size(); ++q) {
    const auto [v0, v1, v2, v3] = mesh.corners[q];
    const std::uint32_t halves[2][3] = {{v0, v1, v3}, {v2, v3, v1}};
    for (std::size_t half = 0; half < (v2 == v3 ? 1u : 2u); ++half) {
      const std::uint32_t t = mesh.triangles[q][half];
      ++seen[t];
      std::vector<std::uint32_t> turned(halves[half], halves[half] + 3);
      for (int turn = 0; turn < 3 && turned[0] != soup.triangles[3 * t]; ++turn)
        std::rotate(turned.begin(), turned.begin() + 1, turned.end());
      EXPECT_TRUE(std::equal(turned.begin(), turned.end(), soup.triangles.begin() + 3 * t)) << "same winding, " << t;
    }
  }
  EXPECT_THAT(seen, testing::Each(1));
}

}  // namespace
}  // namespace understory
