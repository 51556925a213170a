// The cone grid methods on the device: against double, each combining rule, own surfaces, and what must not matter.
#include "host/passes/grid_cone.hpp"

#include <gtest/gtest.h>

#include "host/trace/directions.hpp"
#include "kernels/shared/running_cone.h"
#include "kernels/shared/seen_directions.h"
#include "tests/reference/grid.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/grids.hpp"
#include "tests/support/tolerances.hpp"

namespace understory {
namespace {

Shaded shade(const std::string& method, const std::string& rule, const std::vector<TestFragment>& fragments,
             const std::vector<GridBody>& bodies) {
  return shade_everywhere(fragments, [&](Device& device, int lanes, FragmentPlanes& planes, Buffer<float>& visibility) {
    const GridTable grids = upload_grids(device, bodies, true);
    GridConePass(device, method, rule, lanes).run(planes, body_owners(device, 50), grids, visibility);
  });
}

bool is_own(const GridBody& body, const TestFragment& f) {
  return static_cast<std::int32_t>(f.owner) - 2 == body.group;
}

/// The cone that a body occludes at a fragment of another.
Cone cone_at(const GridBody& body, const TestFragment& f) {
  const OccludedDirections o = reference::look_up(body, f, true);
  const glm::dvec3 d = body.rotation * glm::dvec3(o.direction);
  const Occluded here = {double(o.share), d.x, d.y, d.z};
  return spread_cone(here);
}

/// The rules in double, by the shared text.
double combined(const std::string& rule, const std::vector<GridBody>& bodies, const TestFragment& f) {
  RunningCone running = no_cone();
  SeenDirections seen;
  see_all(&seen);
  const glm::dvec3 n(f.normal);
  double own = 1;
  for (const GridBody& body : bodies) {
    if (is_own(body, f)) {
      if (reference::holds(body, f)) own -= reference::own_blocked(body, f);
      continue;
    }
    const Cone cone = cone_at(body, f);
    const RunningCone next = clip_cone(cone, n.x, n.y, n.z);
    if (next.cosine <= 1e-6) continue;
    cover(&seen, tangents_of(n.x, n.y, n.z), n.x, n.y, n.z, cone, next.cosine);
    (rule == "simple" ? combine_simple : combine_merge)(&running, next);
  }
  if (rule == "union") return own * share_seen(&seen);
  return own * (rule == "simple" ? visibility_simple : visibility_merge)(running, n.x, n.y, n.z);
}

/// The union of the cones themselves, sharp as they are, by 4,096 directions.
double union_by_quadrature(const std::vector<GridBody>& bodies, const TestFragment& f) {
  std::vector<Cone> cones;
  for (const GridBody& body : bodies) cones.push_back(cone_at(body, f));
  const glm::mat3 frame = frame_about(f.normal);
  double sum = 0;
  for (std::uint32_t i = 0; i < 4096; ++i) {
    const glm::dvec3 d(frame * cosine_hemisphere(scrambled_sobol(i, 1)));
    double left = 1;
    for (const Cone& c : cones)
      if (d.x * c.x + d.y * c.y + d.z * c.z > 1 - 2 * c.aperture) left *= 1 - c.opacity;
    sum += left;
  }
  return sum / 4096;
}

TEST(GridCone, ProductOfClippedConesIsTheQuadrature) {
  UNDERSTORY_NEEDS_DEVICE();
  const std::vector<GridBody> bodies = random_bodies(6);
  for (const std::size_t size : {std::size_t{1}, std::size_t{17}, std::size_t{403}}) {
    const std::vector<TestFragment> fragments = fragments_among(size, bodies.size());
    for (const bool paper : {false, true}) {
      const Shaded shaded = shade(paper ? "grid-cone-paper" : "grid-cone", "multiply", fragments, bodies);
      for (std::size_t i = 0; i < size; ++i) {
        double v = 1;
        for (const GridBody& body : bodies)
          if (paper || !is_own(body, fragments[i]))
            v *= 1 - reference::cone_blocked(body, fragments[i], paper);
          else if (reference::holds(body, fragments[i]))
            v *= 1 - reference::own_blocked(body, fragments[i]);
        ASSERT_NEAR(shaded.visibility[i], v, tolerance::grid_cone) << i;
      }
    }
  }
}

TEST(GridCone, OtherRulesAreTheSharedTextInDouble) {
  UNDERSTORY_NEEDS_DEVICE();
  const std::vector<GridBody> bodies = random_bodies(6);
  const std::vector<TestFragment> fragments = fragments_among(1003, bodies.size());
  for (const char* rule : {"simple", "merge", "union"}) {
    const Shaded shaded = shade("grid-cone", rule, fragments, bodies);
    for (std::size_t i = 0; i < fragments.size(); ++i)
      ASSERT_NEAR(shaded.visibility[i], combined(rule, bodies, fragments[i]), tolerance::grid_cone) << rule << ' ' << i;
  }
}

/// A body that occludes the same directions everywhere in its grid.
GridBody everywhere(double share, glm::dvec3 axis, double length) {
  GridBody body;
  const auto samples = std::size_t{8};
  body.grid = {{2, 2, 2},
               glm::vec3(-1),
               glm::vec3(1),
               0,
               std::vector<float>(samples, static_cast<float>(share)),
               std::vector<glm::vec3>(samples, glm::vec3(length * axis))};
  return body;
}

TEST(GridCone, ClosedForms) {
  UNDERSTORY_NEEDS_DEVICE();
  const TestFragment up{glm::vec3(0), glm::vec3(0, 0, 1), 1}, down{glm::vec3(0), glm::vec3(0, 0, -1), 1};
  const auto v = [&](const char* rule, const TestFragment& f, const std::vector<GridBody>& bodies) {
    return shade("grid-cone", rule, {f}, bodies).visibility[0];
  };
  const double share = 51.0 / 255, length = share * (1 - share);  // an opaque cone
  const GridBody above = everywhere(share, {0, 0, 1}, length), beside = everywhere(share, {1, 0, 0}, length);
  for (const char* rule : {"multiply", "simple", "merge", "union"}) {
    EXPECT_NEAR(v(rule, up, {above}), 1 - 4 * share * (1 - share), 0.01) << rule;
    EXPECT_EQ(v(rule, down, {above}), 1) << rule;
  }
  // The same cone twice is one cone; two that are apart add up; multiply knows neither.
  for (const char* rule : {"merge", "union"})
    EXPECT_NEAR(v(rule, up, {above, above}), v(rule, up, {above}), rule == std::string("merge") ? 0.01 : 0.04) << rule;
  EXPECT_LT(v("multiply", up, {above, above}), v("merge", up, {above}) - 0.1);
  const float one = v("merge", up, {everywhere(0.05, {0.6, 0, 0.8}, 0.05 * 0.95)});
  EXPECT_NEAR(
      v("merge", up, {everywhere(0.05, {0.6, 0, 0.8}, 0.05 * 0.95), everywhere(0.05, {-0.6, 0, 0.8}, 0.05 * 0.95)}),
      2 * one - 1, 0.01);
  EXPECT_GT(v("merge", up, {beside}), v("merge", up, {above}));
}

TEST(GridCone, UnionIsNearTheQuadratureAndNearerThanOtherRules) {
  UNDERSTORY_NEEDS_DEVICE();
  // Wide, translucent cones in all directions, seen from planes of every tilt.
  std::vector<GridBody> bodies;
  std::vector<TestFragment> fragments(300);
  Random random(3, stream_of("cones"), 0);
  for (int i = 0; i < 6; ++i) {
    const double aperture = random.uniform(0.05, 0.3), share = random.uniform(0.5, 1) * aperture;
    bodies.push_back(everywhere(share, glm::dvec3(random_direction(random)), share * (1 - aperture)));
    bodies.back().group = i;  // none of them the fragments' own
  }
  for (TestFragment& f : fragments) f = {glm::vec3(0), random_direction(random), 1};
  std::vector<double> wanted;
  for (const TestFragment& f : fragments) wanted.push_back(union_by_quadrature(bodies, f));
  const auto rmse = [&](const char* rule) {
    const Shaded shaded = shade("grid-cone", rule, fragments, bodies);
    double sum = 0;
    for (std::size_t i = 0; i < fragments.size(); ++i) sum += std::pow(double(shaded.visibility[i]) - wanted[i], 2);
    return std::sqrt(sum / static_cast<double>(fragments.size()));
  };
  const double error = rmse("union");
  EXPECT_LT(error, 0.03);
  EXPECT_LT(error, 0.8 * rmse("merge"));
  EXPECT_LT(error, 0.5 * rmse("multiply"));
}

TEST(GridCone, UnionOfOneIsItsClippedConeAndTheOrderDoesNotMatter) {
  UNDERSTORY_NEEDS_DEVICE();
  std::vector<GridBody> bodies = random_bodies(6);
  const std::vector<TestFragment> fragments = fragments_among(403, bodies.size());
  const Shaded alone = shade("grid-cone", "union", fragments, {bodies[1]});
  const Shaded product = shade("grid-cone", "multiply", fragments, {bodies[1]});
  const Shaded forwards = shade("grid-cone", "union", fragments, bodies);
  std::reverse(bodies.begin(), bodies.end());
  const Shaded backwards = shade("grid-cone", "union", fragments, bodies);
  for (std::size_t i = 0; i < fragments.size(); ++i) {
    EXPECT_NEAR(alone.visibility[i], product.visibility[i], 2e-6) << i;
    EXPECT_NEAR(forwards.visibility[i], backwards.visibility[i], 2e-6) << i;
  }
}

TEST(GridCone, AnotherBodyNeverBrightens) {
  UNDERSTORY_NEEDS_DEVICE();
  const std::vector<GridBody> all = random_bodies(5), fewer(all.begin(), all.end() - 1);
  const std::vector<TestFragment> fragments = fragments_among(500, 50);
  for (const char* rule : {"multiply", "merge", "union"}) {
    const Shaded with = shade("grid-cone", rule, fragments, all), without = shade("grid-cone", rule, fragments, fewer);
    for (std::size_t i = 0; i < fragments.size(); ++i)
      EXPECT_LE(with.visibility[i], without.visibility[i] + 1e-6f) << rule << ' ' << i;
  }
}

TEST(GridCone, GarbageStaysInRange) {
  UNDERSTORY_NEEDS_DEVICE();
  std::vector<GridBody> bodies = random_bodies(3);
  for (const char* rule : {"multiply", "simple", "merge", "union"}) shade("grid-cone", rule, garbage(8), bodies);
  shade("grid-cone-paper", "merge", garbage(8), bodies);
  bodies[1].position = glm::dvec3(NAN);
  shade("grid-cone", "merge", garbage(8), bodies);
}

TEST(GridCone, RefusesOtherMethodsAndRules) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  EXPECT_NE(message_of(ErrorKind::unexpected, [&] { GridConePass(device, "grid", "merge"); }).find("'grid'"),
            std::string::npos);
  EXPECT_NE(message_of(ErrorKind::unexpected, [&] { GridConePass(device, "grid-cone", "max"); }).find("'max'"),
            std::string::npos);
}

}  // namespace
}  // namespace understory
