// Ground: heights against planes and grids whose heights are known, borders, holes, and real terrain.
#include "sim/terrain.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/error.hpp"
#include "sim/random.hpp"
#include "tests/support/data.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/temporary_file.hpp"

namespace understory {
namespace {

double plane(glm::dvec2 at) { return 3 + 0.25 * at.x - 0.5 * at.y; }

/// A grid over [-7, 4] x [2, 9] whose nodes lie on `plane`.
Terrain sloped_grid() {
  const std::uint32_t columns = 13, rows = 6;
  const Region extent{{-7, 2}, {4, 9}};
  std::vector<float> heights;
  for (std::uint32_t row = 0; row < rows; ++row)
    for (std::uint32_t column = 0; column < columns; ++column)
      heights.push_back(static_cast<float>(
          plane(extent.low + (extent.high - extent.low) * glm::dvec2(column / (columns - 1.0), row / (rows - 1.0)))));
  return Terrain::from_grid(extent, columns, rows, heights);
}

TEST(Terrain, FlatIsLevelEverywhereAndMadeOfModerateCells) {
  const Terrain terrain = Terrain::flat({{-30, -20}, {31, 47}}, 12.5);
  Random random(1, 1);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(terrain.height_at({random.uniform(-50, 50), random.uniform(-50, 60)}), 12.5);
  EXPECT_EQ(terrain.mesh().parts.at(0).triangles.size(), 3u * 2 * 16 * 17);
  EXPECT_EQ(terrain.mesh().parts.at(0).surface, SurfaceClass::terrain);
  EXPECT_DOUBLE_EQ(terrain.extent().area(), 61 * 67);
}

TEST(Terrain, TrianglesFaceUp) {
  const Terrain terrain = sloped_grid();
  const RawMesh::Part& part = terrain.mesh().parts.at(0);
  for (std::size_t i = 0; i < part.triangles.size(); i += 3) {
    const glm::vec3 a = part.positions[part.triangles[i]], b = part.positions[part.triangles[i + 1]],
                    c = part.positions[part.triangles[i + 2]];
    EXPECT_GT(glm::cross(b - a, c - a).z, 0);
  }
}

TEST(Terrain, HeightsOfAPlaneAreExactUpToFloatNodes) {
  const Terrain terrain = sloped_grid();
  Random random(2, 1);
  for (int i = 0; i < 5000; ++i) {
    const glm::dvec2 at{random.uniform(-7, 4), random.uniform(2, 9)};
    ASSERT_TRUE(terrain.surface_at(at));
    EXPECT_NEAR(*terrain.surface_at(at), plane(at), 1e-6);
  }
}

TEST(Terrain, BeyondTheBorderThereIsNoSurfaceButTheHeightOfTheBorder) {
  const Terrain terrain = sloped_grid();
  EXPECT_FALSE(terrain.surface_at({4.01, 5}));
  EXPECT_FALSE(terrain.surface_at({0, 1.99}));
  EXPECT_NEAR(terrain.height_at({100, 5}), plane({4, 5}), 1e-6);
  EXPECT_NEAR(terrain.height_at({-100, -100}), plane({-7, 2}), 1e-6);
}

TEST(Terrain, OfSeveralLayersTheHighestIsTheGroundAndHolesAreHoles) {
  RawMesh mesh;
  RawMesh::Part low{"low", "", SurfaceClass::wood, {{0, 0, 1}, {10, 0, 1}, {0, 10, 1}}, {0, 1, 2}};
  RawMesh::Part high{"high", "", SurfaceClass::wood, {{0, 0, 5}, {2, 0, 5}, {0, 2, 5}}, {0, 1, 2}};
  mesh.parts = {low, high};
  const Terrain terrain = Terrain::from_mesh(mesh);
  EXPECT_EQ(terrain.surface_at({0.5, 0.5}), 5);
  EXPECT_EQ(terrain.surface_at({4, 4}), 1);
  EXPECT_FALSE(terrain.surface_at({9, 9}));  // inside the bounding rectangle, beside the triangle
  EXPECT_EQ(terrain.height_at({9, 9}), 1);
}

TEST(Terrain, RefusesWhatIsNoGround) {
  EXPECT_THAT(message_of(ErrorKind::invalid_input, [] { Terrain::from_mesh(RawMesh{}); }),
              testing::HasSubstr("without triangles"));
  RawMesh wall;
  wall.parts.push_back({"wall", "", SurfaceClass::wood, {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {0, 1, 2}});
  EXPECT_THAT(message_of(ErrorKind::invalid_input, [&] { Terrain::from_mesh(wall); }),
              testing::HasSubstr("covers no ground"));
  EXPECT_THAT(message_of(ErrorKind::invalid_input,
                         [] {
                           Terrain::from_grid({{0, 0}, {1, 1}}, 3, 2, {1, 2});
                         }),
              testing::HasSubstr("2 heights for a grid of 3 by 2"));
}

TEST(Terrain, RasterIsPlacedByItsMiddle) {
  const TemporaryFile file("hill.asc",
                           "ncols 4\nnrows 3\nxllcorner 500000\nyllcorner 4000000\ncellsize 10\n"
                           "1 2 3 4\n5 6 7 8\n9 10 11 12\n");
  TerrainSource source;
  source.kind = TerrainSource::Kind::raster;
  source.file = file.path();
  source.centre = {100, 200};
  source.height = 0.5;
  const Terrain terrain = read_terrain(source);
  // Samples stand 10 m apart around the centre; the file's last row is the southernmost.
  EXPECT_EQ(terrain.extent().low, glm::dvec2(85, 190));
  EXPECT_EQ(terrain.extent().high, glm::dvec2(115, 210));
  EXPECT_NEAR(terrain.height_at({85, 190}), 9.5, 1e-6);
  EXPECT_NEAR(terrain.height_at({115, 190}), 12.5, 1e-6);
  EXPECT_NEAR(terrain.height_at({85, 210}), 1.5, 1e-6);
  EXPECT_NEAR(terrain.height_at({100, 200}), 7, 1e-6);  // the plane through them
}

TEST(Terrain, RealMeshGivesTheHeightsOfItsVertices) {
  UNDERSTORY_NEEDS_DATA();
  TerrainSource source;
  source.kind = TerrainSource::Kind::mesh;
  source.file = data_folder() / "terrain_maunga_whau.ply";
  source.centre = {100, -50};
  source.height = -90;
  const Terrain terrain = read_terrain(source);
  EXPECT_NEAR(terrain.extent().low.x + terrain.extent().high.x, 200, 0.01);
  EXPECT_NEAR(terrain.extent().low.y + terrain.extent().high.y, -100, 0.01);
  EXPECT_NEAR(terrain.extent().area(), 600.0 * 860, 1);
  double lowest = 1e9, highest = -1e9;
  for (const RawMesh::Part& part : terrain.mesh().parts)
    for (const glm::vec3& vertex : part.positions) {
      EXPECT_NEAR(terrain.height_at(glm::dvec2(vertex)), vertex.z, 1e-4);
      lowest = std::min(lowest, double(vertex.z));
      highest = std::max(highest, double(vertex.z));
    }
  EXPECT_NEAR(highest - lowest, 101, 0.5);
}

}  // namespace
}  // namespace understory
