// The grid methods against traced truth: a convex and a concave body over ground, two overlapping bodies, and the
// border.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/passes/grid.hpp"
#include "host/passes/grid_cone.hpp"
#include "host/trace/directions.hpp"
#include "host/trace/tracer.hpp"
#include "tests/support/grids.hpp"

namespace understory {
namespace {

/// One body or several, where they stand, and their triangles together.
struct Stage {
  std::vector<GridBody> bodies;
  TestMesh all;

  void add(const TestMesh& mesh, glm::vec3 at) {
    GridBody body;
    body.grid = bake_grid(mesh.vertices, mesh.triangles, GridSettings());
    body.position = at;
    body.group = static_cast<std::int32_t>(bodies.size());
    bodies.push_back(body);
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    for (const glm::vec3& p : mesh.vertices) all.vertices.push_back(p + at);
    for (const std::uint32_t index : mesh.triangles) all.triangles.push_back(first + index);
  }
};

/// Points of the ground below the first body's grid: in rows.
std::vector<TestFragment> ground(const Stage& stage, int side) {
  std::vector<TestFragment> all;
  const OcclusionGrid& grid = stage.bodies[0].grid;
  for (int i = 0; i < side * side; ++i) {
    TestFragment f;
    f.owner = 1;
    f.position = glm::vec3(stage.bodies[0].position) +
                 glm::mix(grid.low, grid.high, (glm::vec3(i % side, i / side, 0) + 0.5f) / static_cast<float>(side));
    f.position.z = 0;
    all.push_back(f);
  }
  return all;
}

double traced_visibility(const Tracer& tracer, const TestFragment& f, std::uint32_t seed) {
  constexpr std::uint32_t count = 512;
  std::vector<Ray> rays(count);
  std::vector<std::uint8_t> blocked(count);
  const glm::mat3 frame = frame_about(f.normal);
  for (std::uint32_t i = 0; i < count; ++i) {
    rays[i].origin = f.position + 1e-4f * f.normal;
    rays[i].direction = frame * cosine_hemisphere(scrambled_sobol(i, seed));
  }
  tracer.blocked(rays, blocked);
  return 1 - static_cast<double>(std::count(blocked.begin(), blocked.end(), 1)) / count;
}

/// Distance of the nearest triangle along 256 directions, from just below the ground as well.
float distance_to_body(const Tracer& tracer, const glm::vec3& p) {
  std::vector<Ray> rays(256);
  std::vector<Hit> hits(256);
  for (std::uint32_t i = 0; i < 256; ++i) {
    rays[i].origin = p - glm::vec3(0, 0, 1e-3f);
    rays[i].direction = uniform_sphere(scrambled_sobol(i, 3));
  }
  tracer.nearest(rays, hits);
  float least = INFINITY;
  for (const Hit& hit : hits) least = std::min(least, hit.distance);
  return least;
}

struct Errors {
  double rmse = 0, p99 = 0, bias = 0;
};

Errors errors_of(const std::vector<float>& visibility, const std::vector<double>& truth,
                 const std::vector<bool>& counted) {
  std::vector<double> all;
  Errors e;
  for (std::size_t i = 0; i < truth.size(); ++i)
    if (counted[i]) {
      const double off = double(visibility[i]) - truth[i];
      all.push_back(std::abs(off));
      e.rmse += off * off;
      e.bias += off;
    }
  const auto count = static_cast<double>(all.size());
  std::sort(all.begin(), all.end());
  e.rmse = std::sqrt(e.rmse / count);
  e.bias /= count;
  e.p99 = all[std::min(all.size() - 1, static_cast<std::size_t>(0.99 * count))];
  return e;
}

std::vector<float> shade(const Stage& stage, const std::string& method, const std::string& rule,
                         const std::vector<TestFragment>& fragments) {
  Device device;
  const FragmentPlanes planes = upload_fragments(device, fragments);
  Buffer<float> visibility(device, planes.padded_fragments, "visibility");
  const OwnerTables owners = body_owners(device, stage.bodies.size());
  const GridTable grids = upload_grids(device, stage.bodies, method != "grid");
  if (method == "grid")
    GridPass(device, method).run(planes, owners, grids, visibility);
  else
    GridConePass(device, method, rule).run(planes, owners, grids, visibility);
  return first_of(visibility, fragments.size());
}

void report(const std::string& name, const Errors& e) {
  const auto milli = [](double x) { return static_cast<int>(std::lround(1000 * x)); };
  ::testing::Test::RecordProperty(name + "_rmse_1000", milli(e.rmse));
  ::testing::Test::RecordProperty(name + "_p99_1000", milli(e.p99));
  std::printf("%-24s rmse %.4f p99 %.4f bias %+.4f\n", name.c_str(), e.rmse, e.p99, e.bias);
}

class GridBodyTruth : public ::testing::TestWithParam<bool> {};

TEST_P(GridBodyTruth, OneBodyOverGround) {
  UNDERSTORY_NEEDS_DEVICE();
  Stage stage;
  stage.add(GetParam() ? table() : cube(), glm::vec3(0, 0, GetParam() ? 0.0f : 0.5f));
  const Tracer tracer(stage.all.vertices, stage.all.triangles);
  const std::vector<TestFragment> fragments = ground(stage, 41);
  const OcclusionGrid& grid = stage.bodies[0].grid;
  const glm::vec3 edges = (grid.high - grid.low) / 31.0f;
  const float cell = std::max({edges.x, edges.y, edges.z});
  std::vector<double> truth;
  std::vector<bool> away, contact;
  for (std::size_t i = 0; i < fragments.size(); ++i) {
    truth.push_back(traced_visibility(tracer, fragments[i], static_cast<std::uint32_t>(i)));
    const bool hidden = truth.back() < 0.001;  // the ground under the body
    const bool near = distance_to_body(tracer, fragments[i].position) < cell;
    away.push_back(!hidden && !near);
    contact.push_back(!hidden && near);
  }
  const std::string name = GetParam() ? "table" : "cube";
  const std::vector<float> cone = shade(stage, "grid-cone", "merge", fragments);
  const std::vector<float> scalar = shade(stage, "grid", "", fragments);
  const std::vector<float> paper = shade(stage, "grid-cone-paper", "merge", fragments);
  const Errors e = errors_of(cone, truth, away), s = errors_of(scalar, truth, away);
  report(name + " grid-cone", e);
  report(name + " grid-cone contact", errors_of(cone, truth, contact));
  report(name + " grid-cone-paper", errors_of(paper, truth, away));
  report(name + " grid", s);
  report(name + " grid contact", errors_of(scalar, truth, contact));
  EXPECT_LE(e.rmse, 0.03);
  EXPECT_LE(e.p99, 0.15);
  EXPECT_LE(s.rmse, 0.06);
}
INSTANTIATE_TEST_SUITE_P(Body, GridBodyTruth, ::testing::Bool(),
                         [](const auto& i) { return i.param ? "Concave" : "Convex"; });

TEST(GridTruth, MergeOfOverlappingBoxesBeatsTheirProduct) {
  UNDERSTORY_NEEDS_DEVICE();
  Stage stage;
  stage.add(cube(), glm::vec3(0, 0, 0.5f));
  stage.add(cube(), glm::vec3(0.5f, 0.4f, 0.7f));
  const Tracer tracer(stage.all.vertices, stage.all.triangles);
  const std::vector<TestFragment> fragments = ground(stage, 41);
  std::vector<double> truth;
  std::vector<bool> counted;
  for (std::size_t i = 0; i < fragments.size(); ++i) {
    truth.push_back(traced_visibility(tracer, fragments[i], static_cast<std::uint32_t>(i)));
    counted.push_back(truth.back() > 0.001 && truth.back() < 0.999);
  }
  const auto errors = [&](const char* rule) {
    return errors_of(shade(stage, "grid-cone", rule, fragments), truth, counted);
  };
  const Errors multiply = errors("multiply"), merge = errors("merge");
  report("boxes multiply", multiply);
  report("boxes simple", errors("simple"));
  report("boxes merge", merge);
  EXPECT_LE(merge.rmse, 0.7 * multiply.rmse);
}

TEST(GridTruth, StretchedAndTurnedBodiesAreAsAccurate) {
  UNDERSTORY_NEEDS_DEVICE();
  // A cube stretched unevenly, then baked: a grid of its own.
  TestMesh stone = cube();
  for (glm::vec3& p : stone.vertices) p *= glm::vec3(2, 0.7f, 0.4f);
  Stage stage;
  stage.add(stone, glm::vec3(0, 0, 0.2f));
  const Tracer tracer(stage.all.vertices, stage.all.triangles);
  std::vector<TestFragment> fragments = ground(stage, 21);
  std::vector<double> truth;
  std::vector<bool> counted;
  for (std::size_t i = 0; i < fragments.size(); ++i) {
    truth.push_back(traced_visibility(tracer, fragments[i], static_cast<std::uint32_t>(i)));
    counted.push_back(truth.back() > 0.001 && distance_to_body(tracer, fragments[i].position) > 0.15f);
  }
  // The same place with the whole scene turned.
  const glm::dmat3 turn = glm::mat3_cast(glm::angleAxis(1.1, glm::normalize(glm::dvec3(0.3, -0.5, 0.8))));
  const std::vector<float> straight = shade(stage, "grid-cone", "merge", fragments);
  EXPECT_LE(errors_of(straight, truth, counted).rmse, 0.03);
  stage.bodies[0].rotation = turn;
  stage.bodies[0].position = turn * stage.bodies[0].position;
  for (TestFragment& f : fragments) {
    f.position = glm::vec3(turn * glm::dvec3(f.position));
    f.normal = glm::vec3(turn * glm::dvec3(f.normal));
  }
  const std::vector<float> turned = shade(stage, "grid-cone", "merge", fragments);
  for (std::size_t i = 0; i < fragments.size(); ++i) EXPECT_NEAR(turned[i], straight[i], 1e-3) << i;
}

/// Within 1 mm of all six faces, their edges and corners, a receiver that faces the body is as good as open.
TEST(GridTruth, BordersShowNoSeam) {
  UNDERSTORY_NEEDS_DEVICE();
  for (const GridBorder border : {GridBorder::fade, GridBorder::rescale}) {
    Stage stage;
    stage.add(cube(), glm::vec3(0));
    GridSettings settings;
    settings.border = border;
    const TestMesh mesh = cube();
    stage.bodies[0].grid = bake_grid(mesh.vertices, mesh.triangles, settings);
    const glm::vec3 low = stage.bodies[0].grid.low, high = stage.bodies[0].grid.high;
    std::vector<TestFragment> fragments;
    for (int face = 0; face < 6; ++face)
      for (int i = 0; i <= 40; ++i)
        for (int j = 0; j <= 40; ++j) {
          glm::vec3 part(0);
          part[face / 2] = static_cast<float>(face % 2);
          part[(face / 2 + 1) % 3] = static_cast<float>(i) / 40;
          part[(face / 2 + 2) % 3] = static_cast<float>(j) / 40;
          TestFragment f;
          f.owner = 1;
          const float inset = (i + j) % 2 ? 1e-3f : 1e-5f;
          f.position = glm::clamp(glm::mix(low, high, part), low + inset, high - inset);
          f.normal = glm::normalize(-f.position);
          fragments.push_back(f);
        }
    for (const char* method : {"grid", "grid-cone", "grid-cone-paper"})
      for (const float v : shade(stage, method, "merge", fragments)) ASSERT_LE(1 - v, 1 / 255.0f) << method;
  }
}

}  // namespace
}  // namespace understory
