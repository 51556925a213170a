// Baked grids: closed forms, the steps in order, what must not matter, and bad input.
#include "host/trace/grid_bake.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "host/trace/bake_cache.hpp"
#include "host/trace/grid_cache.hpp"
#include "sim/mesh_shape.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/grids.hpp"
#include "tests/support/temporary_folder.hpp"

namespace understory {
namespace {

OcclusionGrid baked(const TestMesh& mesh, const GridSettings& settings = coarse()) {
  return bake_grid(mesh.vertices, mesh.triangles, settings);
}

bool on_border(const GridSize& size, std::size_t i) {
  const std::size_t x = i % size[0], y = i / size[0] % size[1], z = i / size[0] / size[1];
  return x == 0 || y == 0 || z == 0 || x + 1 == size[0] || y + 1 == size[1] || z + 1 == size[2];
}

TEST(GridExtent, IsEquationFourAndLeavesFlatBodiesAMargin) {
  const Box cube = grid_extent({glm::dvec3(-1), glm::dvec3(1)}, 0.1);
  EXPECT_NEAR(cube.high.x, 1 + std::sqrt(4 / (4 * std::numbers::pi * 0.1)), 1e-12);
  EXPECT_NEAR(cube.high.x, 2.784, 1e-3) << "about three times the body, as the paper says";
  const Box tall = grid_extent({glm::dvec3(0), glm::dvec3(1, 1, 4)}, 0.1);
  EXPECT_NEAR(tall.high.z, 4 + std::sqrt(1 / (0.4 * std::numbers::pi)), 1e-12);
  EXPECT_NEAR(tall.high.x, 1 + std::sqrt(4 / (0.4 * std::numbers::pi)), 1e-12);
  const Box sheet = grid_extent({glm::dvec3(0), glm::dvec3(2, 2, 0)}, 0.1);
  EXPECT_GT(sheet.high.x, 2.2);
  EXPECT_GT(sheet.high.z, 1);
}

TEST(GridBake, AroundASphereIsItsCone) {
  GridSettings settings = coarse({17, 17, 17});
  settings.rays = 256;
  const OcclusionGrid grid = baked(TestMesh().add(ellipsoid_part(glm::dvec3(2))), settings);
  for (std::uint32_t x = 1; x < 16; ++x)
    for (std::uint32_t y = 1; y < 16; ++y) {
      const glm::dvec3 p(grid.position(x, y, 9));
      const double d = glm::length(p);
      const std::size_t i = (9 * 17 + y) * 17 + x;
      if (d < 1.1 || x < 2 || x > 14 || y < 2 || y > 14) continue;  // the outer 1/16 fades
      const double share = (1 - std::sqrt(1 - 1 / (d * d))) / 2;
      EXPECT_NEAR(grid.share[i], share, 0.01) << d;
      const glm::dvec3 direction(grid.direction[i]);
      EXPECT_NEAR(glm::length(direction), share * (1 - share), 0.01) << d;
      EXPECT_GT(glm::dot(glm::normalize(direction), -p / d), 0.999) << d;
    }
}

TEST(GridBake, FillsTheInsideFromItsNeighbours) {
  OcclusionGrid grid;
  grid.size = {5, 5, 5};
  grid.high = glm::vec3(1);
  grid.share.assign(125, 0.25f);
  for (const std::size_t inside : {31u, 32u, 33u, 36u, 37u, 38u, 62u}) grid.share[inside] = 1;
  grid.direction.assign(125, glm::vec3(0.1f, 0, 0));
  grid.direction[62] = glm::vec3(0);
  fill_inside(grid);
  for (const float share : grid.share) EXPECT_FLOAT_EQ(share, 0.25f);
  EXPECT_NEAR(grid.direction[62].x, 0.1f, 1e-6f);
  grid.share.assign(125, 1);  // nothing to fill from
  fill_inside(grid);
  EXPECT_EQ(grid.share[0], 1);
}

TEST(GridBake, TellsTheSolidWhereNoReceiverCanBe) {
  GridSettings settings = coarse({33, 32, 34});
  settings.stretch = 2;
  const OcclusionGrid grid = baked(cube(), settings);
  const std::vector<std::uint8_t> bytes = packed_share(grid);
  const auto inside = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    return glm::all(glm::lessThan(glm::abs(grid.position(x, y, z)), glm::vec3(0.5f)));
  };
  std::size_t solid = 0;
  for (std::uint32_t z = 0; z < 34; ++z)
    for (std::uint32_t y = 0; y < 32; ++y)
      for (std::uint32_t x = 0; x < 33; ++x) {
        const std::size_t i = (std::size_t(z) * 32 + y) * 33 + x;
        // The neighbours span a box that lies in the cube where two of its corners do.
        const bool surrounded = inside(x, y, z) && inside(x - 1, y - 1, z - 1) && inside(x + 1, y + 1, z + 1);
        EXPECT_EQ(grid.share[i] == 1, surrounded);
        EXPECT_EQ(bytes[i] == 255, surrounded);
        if (surrounded) {
          EXPECT_EQ(grid.direction[i], glm::vec3(0));
        }
        solid += surrounded;
      }
  EXPECT_GT(solid, 20u);
  OcclusionGrid nearly = grid;
  nearly.share.assign(grid.samples(), 0.9985f);
  EXPECT_EQ(packed_share(nearly)[0], 254) << "no crevice is taken for the solid";
  EXPECT_NE(message_of(ErrorKind::unexpected, [&] { close_solid(nearly, {}); }).find("one flag"), std::string::npos);
}

TEST(GridBake, BothBordersAreOpenAndRescaleCanBeUndone) {
  GridSettings settings = coarse();
  const TestMesh mesh = cube();
  const OcclusionGrid fade = baked(mesh, settings);
  settings.border = GridBorder::rescale;
  const OcclusionGrid rescaled = baked(mesh, settings);
  EXPECT_EQ(fade.border, 0);
  EXPECT_GT(rescaled.border, 0.02f);
  for (std::size_t i = 0; i < fade.samples(); ++i) {
    if (on_border(fade.size, i)) {
      EXPECT_EQ(fade.share[i], 0);
      EXPECT_EQ(rescaled.share[i], 0);
    }
    if (fade.share[i] == 1) continue;  // within the solid
    EXPECT_LE(glm::length(fade.direction[i]), fade.share[i] * (1 - fade.share[i]) + 0.03f);
  }
  // In the middle nothing is faded: there the rescale is eq. (V - M)/(1 - M) of the same number.
  const std::size_t middle = (std::size_t(5) * 10 + 5) * 9 + 1;
  EXPECT_NEAR(rescaled.share[middle] * (1 - rescaled.border) + rescaled.border, fade.share[middle], 1e-5f);
}

TEST(GridBake, DoesNotDependOnThreadsOrWindingButOnTheSeed) {
  const TestMesh mesh = table();
  const OcclusionGrid many = baked(mesh);
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(baked(mesh).share, many.share);
  }
  TestMesh inside_out = mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3)
    std::swap(inside_out.triangles[t], inside_out.triangles[t + 1]);
  const OcclusionGrid turned = baked(inside_out);
  double most = 0;
  for (std::size_t i = 0; i < many.samples(); ++i)
    most = std::max(most, std::abs(double(many.share[i]) - double(turned.share[i])));
  EXPECT_LT(most, 0.02);  // rays along an edge may pass on one side or the other
  GridSettings other = coarse();
  other.seed = 2;
  EXPECT_NE(baked(mesh, other).share, many.share);
}

TEST(GridBake, EightBitsCostTheirRounding) {
  const OcclusionGrid grid = baked(table());
  const OcclusionGrid cone = unpacked(grid, packed_cone(grid)), scalar = unpacked(grid, packed_share(grid));
  EXPECT_EQ(packed_cone(grid).size(), 4 * grid.samples());
  EXPECT_EQ(packed_share(grid).size(), grid.samples());
  EXPECT_FALSE(scalar.has_direction());
  for (std::size_t i = 0; i < grid.samples(); ++i) {
    EXPECT_NEAR(cone.share[i], grid.share[i], 1 / 510.0 + 1e-6);
    EXPECT_NEAR(scalar.share[i], grid.share[i], 1 / 510.0 + 1e-6);
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(cone.direction[i][axis], grid.direction[i][axis], 1 / 1016.0 + 1e-6);
  }
  EXPECT_EQ(GridSettings().size, (GridSize{32, 32, 32}));  // 32 KiB and 128 KiB
}

TEST(GridBake, OpenFlatAndSingleTrianglesAreBakedWithoutAnInside) {
  TestMesh one;
  one.vertices = {glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)};
  one.triangles = {0, 1, 2};
  TestMesh open = cube();
  open.triangles.resize(open.triangles.size() - 6);  // a box without a face
  for (const TestMesh& mesh : {one, open}) {
    const OcclusionGrid grid = baked(mesh);
    for (std::size_t i = 0; i < grid.samples(); ++i) EXPECT_TRUE(grid.share[i] >= 0 && grid.share[i] < 1);
    EXPECT_GT(*std::max_element(grid.share.begin(), grid.share.end()), 0.02f);
    EXPECT_GT(mesh_shape(mesh.vertices, mesh.triangles).open_edges, 0u);
  }
  EXPECT_EQ(mesh_shape(cube().vertices, cube().triangles).open_edges, 0u);
  EXPECT_NEAR(mesh_shape(cube().vertices, cube().triangles).volume, 1, 1e-6);
}

TEST(GridBake, RefusesWhatItCannotDo) {
  const TestMesh mesh = cube();
  const auto message = [&](const TestMesh& of, const GridSettings& settings) {
    return message_of(ErrorKind::invalid_input, [&] { baked(of, settings); });
  };
  EXPECT_NE(message(mesh, coarse({1, 32, 32})).find("grid size 1"), std::string::npos);
  EXPECT_NE(message(mesh, coarse({32, 32, 10000})).find("2 to 512"), std::string::npos);
  GridSettings settings = coarse();
  settings.epsilon = 0;
  EXPECT_NE(message(mesh, settings).find("epsilon 0"), std::string::npos);
  settings = coarse();
  settings.rays = 1;
  EXPECT_NE(message(mesh, settings).find("rays"), std::string::npos);
  EXPECT_NE(message(TestMesh(), coarse()).find("no triangles"), std::string::npos);
  TestMesh bad = mesh;
  bad.vertices[3].y = NAN;
  EXPECT_NE(message(bad, coarse()).find("vertex 3"), std::string::npos);
  bad = mesh;
  bad.triangles[0] = 999;
  EXPECT_NE(message(bad, coarse()).find("999"), std::string::npos);
  bad = mesh;
  for (glm::vec3& p : bad.vertices) p = glm::vec3(p.x, 0, 0);
  EXPECT_NE(message(bad, coarse()).find("no area"), std::string::npos);
}

TEST(GridCache, GivesWhatWasBakedForTheSameMeshAndSettings) {
  const TemporaryFolder folder;
  setenv("XDG_CACHE_HOME", folder.path().c_str(), 1);
  const auto cached = [](const TestMesh& mesh, const GridSettings& settings) {
    return cached_grid(mesh.vertices, mesh.triangles, settings);
  };
  const TestMesh mesh = cube();
  const OcclusionGrid fresh = cached(mesh, coarse()), again = cached(mesh, coarse());
  EXPECT_EQ(fresh.share, baked(mesh).share);
  EXPECT_EQ(again.share, fresh.share);
  EXPECT_EQ(again.direction, fresh.direction);
  EXPECT_EQ(again.low, fresh.low);
  EXPECT_EQ(bake_cache_info().files, 1u);
  TestMesh moved = mesh;
  moved.vertices[0].x -= 0.01f;
  EXPECT_NE(cached(moved, coarse()).share, fresh.share);
  GridSettings other = coarse();
  other.cone = false;
  EXPECT_FALSE(cached(mesh, other).has_direction());
  EXPECT_EQ(bake_cache_info().files, 3u);
}

}  // namespace
}  // namespace understory
