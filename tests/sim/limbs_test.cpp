// Limbs found in meshes: a plant made by hand, and every real one of the data folder.
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <numeric>

#include "sim/files/mesh.hpp"
#include "sim/plants/limbs.hpp"
#include "sim/plants/nearest_points.hpp"
#include "sim/plants/pieces.hpp"
#include "sim/plants/species.hpp"
#include "sim/random.hpp"
#include "tests/support/data.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/prototypes.hpp"

namespace understory {
namespace {

/// A four-sided open tube that thins from `radius` to half of it.
void add_tube(RawMesh::Part& part, glm::vec3 base, glm::vec3 tip, float radius) {
  const glm::vec3 axis = glm::normalize(tip - base);
  const glm::vec3 helper = std::abs(axis.z) > 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
  const glm::vec3 side = glm::normalize(glm::cross(helper, axis)), other = glm::cross(axis, side);
  const std::uint32_t first = static_cast<std::uint32_t>(part.positions.size());
  for (int ring = 0; ring < 2; ++ring) {
    for (glm::vec3 out : {side, other, -side, -other}) {
      part.positions.push_back((ring == 0 ? base : tip) + (ring == 0 ? radius : 0.5f * radius) * out);
    }
  }
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::uint32_t a = first + k, b = first + (k + 1) % 4;
    part.triangles.insert(part.triangles.end(), {a, b, b + 4, a, b + 4, a + 4});
  }
}

void add_leaf(RawMesh::Part& part, glm::vec3 at) {
  const std::uint32_t first = static_cast<std::uint32_t>(part.positions.size());
  part.positions.insert(part.positions.end(), {at, at + glm::vec3(0.1, 0.05, 0), at + glm::vec3(0.1, -0.05, 0)});
  part.triangles.insert(part.triangles.end(), {first, first + 1, first + 2});
}

/// A trunk, a bough to the right, a branch up from the bough, and a short twig on the branch; a leaf on each.
RawMesh small_tree() {
  RawMesh mesh;
  mesh.parts = {{"tree", "wood", SurfaceClass::wood, {}, {}}, {"tree", "leaf", SurfaceClass::leaf, {}, {}}};
  add_tube(mesh.parts[0], {0, 0, 0}, {0, 0, 6}, 0.3f);
  add_tube(mesh.parts[0], {0, 0, 3}, {3, 0, 3.5}, 0.1f);
  add_tube(mesh.parts[0], {2, 0, 3.33}, {2.2, 0, 4.5}, 0.04f);
  add_tube(mesh.parts[0], {2.1, 0, 4}, {2.2, 0.1, 4.05}, 0.01f);
  add_leaf(mesh.parts[1], {0.2, 0, 5.9});
  add_leaf(mesh.parts[1], {2.9, 0, 3.55});
  add_leaf(mesh.parts[1], {2.25, 0.02, 4.45});
  return mesh;
}

std::uint32_t limb_of_leaf(const Prototype& plant, glm::vec3 at) {
  for (const TriangleRun& run : plant.runs) {
    if (run.surface != SurfaceClass::leaf) continue;
    for (std::uint32_t i = 3 * run.first; i < 3 * (run.first + run.count); ++i) {
      const std::uint32_t vertex = plant.triangles[i];
      if (glm::distance(position_of(plant, vertex), at) < 1e-5f)
        return plant.vertices.block_limb[vertex / vertex_block];
    }
  }
  ADD_FAILURE() << "no such leaf";
  return 0;
}

SpeciesSource mesh_source() {
  SpeciesSource source;
  source.name = "tree";
  source.mesh = "tree.obj";
  return source;
}

TEST(Limbs, FollowTheBranchingOfAMesh) {
  const RawMesh mesh = small_tree();
  const Prototype plant = build_species(mesh_source(), 5, &mesh).prototype;
  expect_sound(plant);
  ASSERT_EQ(plant.limbs.size(), 3u) << "the twig is too short";
  EXPECT_EQ(plant.limbs[0].kind, SwayKind::trunk);
  EXPECT_EQ(plant.limbs[0].parent, -1);
  EXPECT_LT(glm::distance(plant.limbs[0].base, glm::vec3(0, 0, 0)), 0.05f);
  EXPECT_NEAR(plant.limbs[0].reach, 0.3, 0.05);
  EXPECT_EQ(plant.limbs[1].kind, SwayKind::branch);
  EXPECT_EQ(plant.limbs[1].parent, 0);
  EXPECT_LT(glm::distance(plant.limbs[1].base, glm::vec3(0, 0, 3)), 0.05f);
  EXPECT_GT(plant.limbs[1].axis.x, 0.95f);
  EXPECT_EQ(plant.limbs[2].parent, 1) << "the branch hangs on the bough, not on the trunk";
  EXPECT_EQ(limb_of_leaf(plant, {0.2f, 0, 5.9f}), 0u);
  EXPECT_EQ(limb_of_leaf(plant, {2.9f, 0, 3.55f}), 1u);
  EXPECT_EQ(limb_of_leaf(plant, {2.25f, 0.02f, 4.45f}), 2u);
}

TEST(Limbs, ScaleWithTheHeightAskedFor) {
  const RawMesh mesh = small_tree();
  SpeciesSource source = mesh_source();
  source.height = 12;
  const Prototype plant = build_species(source, 5, &mesh).prototype;
  expect_sound(plant);
  EXPECT_NEAR(plant.high.z, 12, 1e-4);
  EXPECT_NEAR(plant.limbs[0].reach, 0.6, 0.1);
}

TEST(Limbs, AMeshOfBladesIsOneStiffTrunkWhoseBladesFlutter) {
  RawMesh mesh;
  mesh.parts = {{"lawn", "blade", SurfaceClass::blade, {}, {}}};
  Random random(3, stream_of("lawn"));
  for (int blade = 0; blade < 77; ++blade) {
    const glm::vec3 root(random.uniform(0, 2), random.uniform(0, 2), 0);
    const std::uint32_t first = static_cast<std::uint32_t>(mesh.parts[0].positions.size());
    mesh.parts[0].positions.insert(mesh.parts[0].positions.end(),
                                   {root, root + glm::vec3(0.01, 0, 0), root + glm::vec3(0, 0.02, 0.2)});
    mesh.parts[0].triangles.insert(mesh.parts[0].triangles.end(), {first, first + 1, first + 2});
  }
  const Prototype lawn = build_species(mesh_source(), 5, &mesh).prototype;
  expect_sound(lawn);
  ASSERT_EQ(lawn.limbs.size(), 1u);
  EXPECT_LT(lawn.limbs[0].flexibility, 1);
  for (std::uint32_t i = 0; i < lawn.vertices.x.size(); ++i) {
    EXPECT_NEAR(glm::length(flutter_of(lawn, i)), lawn.vertices.z[i] > 0.1f ? 0.06f : 0, 0.004f);
  }
}

TEST(Limbs, WoodInSmallPiecesIsOneTrunk) {
  RawMesh mesh;
  mesh.parts = {{"scan", "wood", SurfaceClass::wood, {}, {}}};
  for (int i = 0; i < 40; ++i) add_tube(mesh.parts[0], {0, 0, 0.1 * i}, {0, 0, 0.1 * i + 0.08}, 0.02f);
  const Prototype scan = build_species(mesh_source(), 5, &mesh).prototype;
  expect_sound(scan);
  ASSERT_EQ(scan.limbs.size(), 1u);
  EXPECT_NEAR(scan.limbs[0].length, 3.98, 1e-3);
  EXPECT_GT(scan.crown.sphere_radius, 1.9f) << "leafless: the crown is the wood's";
}

TEST(Limbs, RejectAMeshWithoutTriangles) {
  const RawMesh mesh;
  EXPECT_THAT(message_of(ErrorKind::invalid_input, [&] { build_species(mesh_source(), 5, &mesh); }),
              testing::HasSubstr("no triangle"));
}

TEST(Pieces, JoinOverVerticesAndPositions) {
  const std::vector<glm::vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {9, 9, 9}, {1, 0, 0},
                                         {2, 0, 0}, {2, 1, 0}, {5, 5, 5}, {6, 5, 5}, {5, 6, 5}};
  const Pieces pieces = connected_pieces(positions, {0, 1, 2, 4, 5, 6, 7, 8, 9});
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_EQ(pieces.of_vertex, (std::vector<std::uint32_t>{0, 0, 0, no_piece, 0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(pieces.vertices, (std::vector<std::uint32_t>{0, 1, 2, 4, 5, 6, 7, 8, 9}));
}

TEST(Pieces, JoinCornersThatWereRoundedApart) {
  // Two leaves of two triangles on a plant 2 m tall, each triangle with corners of its own, 3 micrometres off: one
  // leaf. The second stands 0.1 mm from the first: another leaf.
  const auto leaf = [](float height, float error) {
    return std::vector<glm::vec3>{{0, 0, height},         {0.05f, 0, height},     {0, 0.05f, height},
                                  {0.05f, error, height}, {0.05f, 0.05f, height}, {0, 0.05f + error, height - error}};
  };
  std::vector<glm::vec3> positions = leaf(2, 3e-6f);
  for (const glm::vec3 p : leaf(2.0001f, -3e-6f)) positions.push_back(p);
  for (const glm::vec3 p : {glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)}) positions.push_back(p);
  std::vector<std::uint32_t> triangles(positions.size());
  std::iota(triangles.begin(), triangles.end(), 0u);
  const Pieces pieces = connected_pieces(positions, triangles, 1e-5f);
  ASSERT_EQ(pieces.size(), 3u);
  EXPECT_EQ(connected_pieces(positions, triangles).size(), 5u) << "to the bit";
  for (std::uint32_t i = 0; i < 15; ++i) EXPECT_EQ(pieces.of_vertex[i], i / 6) << i;
}

TEST(NearestPoints, AgreeWithTryingAll) {
  Random random(1, stream_of("points"));
  const auto point = [&] { return glm::vec3(random.uniform(), random.uniform(), random.uniform()); };
  std::vector<NearestPoints::Point> points;
  for (std::uint32_t i = 0; i < 503; ++i) points.push_back({point(), static_cast<std::uint32_t>(random.below(60))});
  const NearestPoints tree(points);
  for (int trial = 0; trial < 401; ++trial) {
    const glm::vec3 at = point();
    const std::uint32_t limit = static_cast<std::uint32_t>(random.below(62));
    float nearest = 1e30f;
    for (const NearestPoints::Point& candidate : points) {
      if (candidate.label < limit) nearest = std::min(nearest, glm::distance(candidate.position, at));
    }
    const NearestPoints::Hit hit = tree.nearest(at, limit);
    ASSERT_EQ(hit.found, nearest < 1e29f);
    if (hit.found) {
      ASSERT_NEAR(std::sqrt(hit.squared_distance), nearest, 1e-6);
      ASSERT_LT(hit.point.label, limit);
    }
  }
}

struct RealPlant {
  std::string file;
  std::size_t fewest_limbs, most_limbs;
  std::size_t trunks;  // 0: any number
};

void PrintTo(const RealPlant& plant, std::ostream* out) { *out << plant.file; }

class RealPlants : public testing::TestWithParam<RealPlant> {};
INSTANTIATE_TEST_SUITE_P(
    Data, RealPlants,
    testing::Values(RealPlant{"birch", 40, 400, 1}, RealPlant{"grass_lawn_2m", 1, 1, 1},
                    RealPlant{"grass_wheat_6x6", 36, 400, 0}, RealPlant{"sapling_eucalyptus_pilularis", 1, 400, 1},
                    RealPlant{"shrub_bougainvillea", 20, 400, 1}, RealPlant{"tree_broadleaf_black_oak", 100, 400, 1},
                    RealPlant{"tree_multicrown_oak_cards", 50, 400, 1}, RealPlant{"tree_poplar_lombardy", 50, 400, 1},
                    RealPlant{"tree_scanned_qsm_coffeetree", 1, 400, 1}, RealPlant{"tree_walnut_digitized", 1, 400, 1}),
    [](const auto& test) { return test.param.file; });

TEST_P(RealPlants, BecomeSoundPrototypes) {
  UNDERSTORY_NEEDS_DATA();
  const RealPlant& expected = GetParam();
  const RawMesh mesh = read_mesh(data_folder() / "plants" / (expected.file + ".glb"), UpAxis::y,
                                 {"leaf*", "needle*", "flower*", "blade*"});
  std::size_t triangles = 0;
  for (const RawMesh::Part& part : mesh.parts) triangles += part.triangles.size() / 3;
  const Species species = build_species(mesh_source(), 5, &mesh);
  const Prototype& plant = species.prototype;
  expect_sound(plant);
  EXPECT_EQ(plant.triangle_count(), triangles) << "zero-area triangles were dropped from the data already";
  EXPECT_GE(plant.limbs.size(), expected.fewest_limbs);
  EXPECT_LE(plant.limbs.size(), expected.most_limbs);
  std::size_t trunks = 0;
  for (const Limb& limb : plant.limbs) trunks += limb.parent < 0;
  EXPECT_TRUE(expected.trunks == 0 || trunks == expected.trunks) << trunks << " trunks";
  EXPECT_GT(species.alpha_rho, 0);
  EXPECT_GT(species.reeves_blau_extinction, 0);
  EXPECT_GT(species.opacity, 0.05);
  EXPECT_LT(species.opacity, 1);
}

/// Distance of a point to a triangle, by trying the plane and the three edges.
float distance_to_triangle(glm::vec3 p, const std::array<glm::vec3, 3>& corner) {
  const glm::vec3 normal = glm::normalize(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
  const float above = glm::dot(p - corner[0], normal);
  bool inside = true;
  float nearest = 1e30f;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::vec3 a = corner[k], edge = corner[(k + 1) % 3] - a;
    inside = inside && glm::dot(glm::cross(normal, edge), p - a) >= 0;
    const float at = glm::clamp(glm::dot(p - a, edge) / glm::dot(edge, edge), 0.0f, 1.0f);
    nearest = std::min(nearest, glm::distance(p, a + at * edge));
  }
  return inside ? std::abs(above) : nearest;
}

TEST_P(RealPlants, HangLimbsOnTheirParents) {
  UNDERSTORY_NEEDS_DATA();
  const RawMesh mesh = read_mesh(data_folder() / "plants" / (GetParam().file + ".glb"), UpAxis::y,
                                 {"leaf*", "needle*", "flower*", "blade*"});
  const LimbMesh plant = limbs_from_mesh(mesh, 5);
  const auto found = plant.triangles.find(SurfaceClass::wood);
  if (found == plant.triangles.end()) return;
  std::vector<std::vector<std::array<glm::vec3, 3>>> wood(plant.limbs.size());
  float height = 0;
  for (std::size_t i = 0; i < found->second.size(); i += 3) {
    const std::uint32_t* corner = &found->second[i];
    wood[plant.limb[corner[0]]].push_back(
        {plant.positions[corner[0]], plant.positions[corner[1]], plant.positions[corner[2]]});
    height = std::max(height, plant.positions[corner[0]].z);
  }
  // A leaf stalk may hang on a shorter piece of stem than itself, which then passes for its child: rare and near.
  std::size_t loose = 0;
  for (const Limb& limb : plant.limbs) {
    if (limb.parent < 0) continue;
    float nearest = 1e30f;
    for (const auto& triangle : wood[static_cast<std::size_t>(limb.parent)]) {
      nearest = std::min(nearest, distance_to_triangle(limb.base, triangle));
    }
    loose += nearest > 0.02f * height;
    EXPECT_LT(nearest, 0.08f * height);
  }
  EXPECT_LE(loose, plant.limbs.size() / 20);
}

TEST(RealPlantAreas, MatchThePublishedLeafArea) {
  UNDERSTORY_NEEDS_DATA();
  // data/MANIFEST.md: the package states 0.537405 m^2 for the hand-digitised blackbutt sapling.
  const RawMesh mesh = read_mesh(data_folder() / "plants" / "sapling_eucalyptus_pilularis.glb", UpAxis::y, {"leaf*"});
  EXPECT_NEAR(build_species(mesh_source(), 5, &mesh).prototype.crown.leaf_area, 0.537405, 1e-5);
}

}  // namespace
}  // namespace understory
