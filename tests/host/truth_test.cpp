// The traced truth against scenes whose visibility is known in closed form, and its intervals against many more rays.
#include "host/trace/truth.hpp"

#include <gmock/gmock.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <vector>

#include "host/trace/directions.hpp"
#include "sim/random.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/triangles.hpp"

namespace understory {
namespace {

Truth at_point(const Tracer& tracer, glm::vec3 position, glm::vec3 normal, TruthOptions options = {}) {
  options.rays = 4096;
  return trace_truth(tracer, std::vector<glm::vec3>{position}, std::vector<glm::vec3>{glm::normalize(normal)}, options);
}

void expect_value(const Truth& truth, double expected) {
  EXPECT_NEAR(truth.visibility[0], expected, truth.halfwidth[0]);
  EXPECT_LT(truth.halfwidth[0], 0.01);
  EXPECT_GT(truth.halfwidth[0], 0);
  EXPECT_EQ(truth.rays[0], 4096u);
}

TEST(Truth, OfATiltedPlaneIsTheShareOfTheDomeAboveIt) {
  const Tracer nothing({}, {});
  for (const double degrees : {0.0, 35.0, 90.0, 120.0, 180.0}) {
    const double tilt = degrees * M_PI / 180;
    const glm::vec3 normal(std::sin(tilt), 0, std::cos(tilt));
    expect_value(at_point(nothing, {1, 2, 3}, normal), (1 + std::cos(tilt)) / 2);
    expect_value(at_point(nothing, {1, 2, 3}, normal, {.weighting = Weighting::uniform}), 1 - tilt / M_PI);
    expect_value(at_point(nothing, {1, 2, 3}, normal, {.sky = Sky::sphere}), 1);
    expect_value(at_point(nothing, {1, 2, 3}, normal, {.max_distance = 5}), 1);  // no horizon in the near field
  }
}

TEST(Truth, OfAGroundedPlaneDoesNotSeeItself) {
  for (const glm::vec3 centre : {glm::vec3(0), glm::vec3(700, -900, 40)}) {
    const Triangles ground = rectangle(centre - glm::vec3(50, 50, 0), {100, 0, 0}, {0, 100, 0});
    const Tracer tracer(ground.vertices, ground.triangles);
    for (float x = 0.3f; x < 20; x += 1.7f) {
      const Truth up = at_point(tracer, centre + glm::vec3(x, -x, 0), {0, 0, 1}, {.sky = Sky::sphere});
      EXPECT_EQ(up.visibility[0], 1) << "no ray may start inside its own surface";
    }
  }
}

TEST(Truth, UnderAnOpaqueBall) {
  const double radius = 1.5, distance = 2.5;
  const Triangles ball = sphere(150, {0, 0, static_cast<float>(distance)}, static_cast<float>(radius));
  const Tracer tracer(ball.vertices, ball.triangles);
  const double squared = radius * radius / (distance * distance);
  expect_value(at_point(tracer, {0, 0, 0}, {0, 0, 1}), 1 - squared);
  expect_value(at_point(tracer, {0, 0, 0}, {0.4f, 0, 1}, {.sky = Sky::sphere}), 1 - squared / std::hypot(0.4, 1));
  expect_value(at_point(tracer, {0, 0, 0}, {0, 0, 1}, {.weighting = Weighting::uniform}), std::sqrt(1 - squared));
  expect_value(at_point(tracer, {0, 0, 0}, {0, 0, 1}, {.max_distance = 0.9f}), 1);  // the ball begins at 1 m
  EXPECT_LT(at_point(tracer, {0, 0, 0}, {0, 0, 1}, {.max_distance = 1.2f}).visibility[0], 0.95);
}

TEST(Truth, AtTheFootOfAWallAndInABox) {
  const Triangles wall = rectangle({0, -3e4f, 0}, {0, 6e4f, 0}, {0, 0, 3e4f});
  const Tracer before_wall(wall.vertices, wall.triangles);
  expect_value(at_point(before_wall, {1, 0, 0}, {0, 0, 1}), 0.5);
  const Triangles box = sphere(2, glm::vec3(0), 1);  // an octahedron
  const Tracer in_box(box.vertices, box.triangles);
  const Truth closed = at_point(in_box, {0.1f, 0, -0.1f}, {0, 0.6f, 0.8f}, {.sky = Sky::sphere});
  EXPECT_EQ(closed.visibility[0], 0);
  EXPECT_NEAR(closed.halfwidth[0], 3.84 / 4100, 1e-5) << "Wilson's upper limit with nothing seen";
}

/// A ball of leaves and points on them, each with the normal of its leaf.
struct Crown {
  Triangles leaves;
  std::vector<glm::vec3> positions, normals;
};

Crown random_crown(int leaves, int points) {
  Crown crown;
  for (int i = 0; i < leaves; ++i) {
    Random random(21, stream_of("crown"), static_cast<std::uint64_t>(i));
    const auto u = [&] { return static_cast<float>(random.uniform()); };
    const glm::vec3 centre = std::cbrt(u()) * uniform_sphere({u(), u()}), normal = uniform_sphere({u(), u()});
    add_square(crown.leaves, centre, normal, 0.07f);
    if (i >= points) continue;
    crown.positions.push_back(centre + 0.01f * frame_about(normal)[0]);
    crown.normals.push_back(normal);
  }
  return crown;
}

TEST(Truth, IntervalsHoldTheTruth) {
  const Crown crown = random_crown(4000, 800);
  const Tracer tracer(crown.leaves.vertices, crown.leaves.triangles);
  for (const Sky sky : {Sky::dome, Sky::sphere}) {
    const Truth exact = trace_truth(tracer, crown.positions, crown.normals, {.rays = 16384, .seed = 9, .sky = sky});
    for (const int rays : {32, 64, 256}) {
      const Truth truth = trace_truth(tracer, crown.positions, crown.normals, {.rays = rays, .sky = sky});
      int held = 0;
      std::vector<int> tenth_held(10, 0), tenth_count(10, 0);
      for (std::size_t i = 0; i < exact.visibility.size(); ++i) {
        const bool inside = std::abs(truth.visibility[i] - exact.visibility[i]) <= truth.halfwidth[i];
        const auto tenth = std::min<std::size_t>(9, static_cast<std::size_t>(10 * exact.visibility[i]));
        held += inside;
        tenth_held[tenth] += inside;
        ++tenth_count[tenth];
      }
      EXPECT_GE(held, 0.93 * 800) << rays << " rays";
      for (std::size_t tenth = 0; tenth < 10; ++tenth) {  // three standard errors of a share of 0.95
        const double count = tenth_count[tenth];
        EXPECT_GE(tenth_held[tenth], 0.95 * count - 3 * std::sqrt(0.0475 * count)) << rays << " rays, tenth " << tenth;
      }
    }
  }
}

TEST(Truth, IsUnbiasedAndConverges) {
  const Crown crown = random_crown(4000, 400);
  const Tracer tracer(crown.leaves.vertices, crown.leaves.triangles);
  const auto error = [&](int rays) {
    const Truth a = trace_truth(tracer, crown.positions, crown.normals, {.rays = rays, .seed = 1});
    const Truth b = trace_truth(tracer, crown.positions, crown.normals, {.rays = 4096, .seed = 2});
    double squares = 0, sum = 0;
    for (std::size_t i = 0; i < a.visibility.size(); ++i) {
      const double e = a.visibility[i] - b.visibility[i];
      squares += e * e;
      sum += e;
    }
    const double rms = std::sqrt(squares / 400);
    EXPECT_LT(std::abs(sum / 400), 4 * rms / 20) << "bias";
    return rms;
  };
  const double few = error(32), many = error(512);
  EXPECT_LT(many, few / 4) << "faster than 1/sqrt(rays), which would give 1/4";
}

TEST(Truth, DoesNotDependOnThreadsOrPortions) {
  const Crown crown = random_crown(500, 150);
  const Tracer tracer(crown.leaves.vertices, crown.leaves.triangles);
  const Truth whole = trace_truth(tracer, crown.positions, crown.normals, {.rays = 64});
  {
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    const Truth alone = trace_truth(tracer, crown.positions, crown.normals, {.rays = 64});
    EXPECT_EQ(alone.visibility, whole.visibility);
    EXPECT_EQ(alone.halfwidth, whole.halfwidth);
  }
  const std::span<const glm::vec3> positions(crown.positions), normals(crown.normals);
  const Truth rest = trace_truth(tracer, positions.subspan(37), normals.subspan(37), {.rays = 64, .first_point = 37});
  EXPECT_TRUE(std::equal(rest.visibility.begin(), rest.visibility.end(), whole.visibility.begin() + 37));
  const Truth other = trace_truth(tracer, crown.positions, crown.normals, {.rays = 64, .seed = 2});
  EXPECT_NE(other.visibility, whole.visibility);
}

TEST(Truth, TellsWhatItCannotTrace) {
  const Tracer nothing({}, {});
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), endless = std::numeric_limits<float>::infinity();
  const std::vector<glm::vec3> positions = {{nan, 0, 0}, {0, 0, 0}, {0, endless, 0}, {0, 0, 0}},
                               normals = {{0, 0, 1}, {0, 0, 0}, {0, 0, 1}, {0, nan, 1}};
  const Truth truth = trace_truth(nothing, positions, normals, {});
  EXPECT_THAT(truth.rays, testing::Each(0u));
  EXPECT_THAT(truth.visibility, testing::Each(1.0f));
  EXPECT_THAT(truth.halfwidth, testing::Each(1.0f));
  const auto message = [&](const TruthOptions& options, std::size_t points) {
    return message_of(ErrorKind::invalid_input,
                      [&] { (void)trace_truth(nothing, std::span(positions).first(points), normals, options); });
  };
  EXPECT_THAT(message({.rays = 15}, 4), testing::HasSubstr("15 rays; allowed: 16"));
  EXPECT_THAT(message({.max_distance = 0}, 4), testing::HasSubstr("largest distance"));
  EXPECT_THAT(message({.max_distance = nan}, 4), testing::HasSubstr("largest distance"));
  EXPECT_THAT(message({}, 3), testing::HasSubstr("3 positions and 4 normals"));
}

}  // namespace
}  // namespace understory
