// Generated plants: sound meshes, connected wood, and what was asked for in height and leaves.
#include <gmock/gmock.h>

#include <cmath>

#include "sim/plants/presets.hpp"
#include "sim/plants/skeleton.hpp"
#include "sim/plants/species.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/prototypes.hpp"

namespace understory {
namespace {

constexpr std::uint64_t seed = 11;

SpeciesSource source_of(const std::string& generator, int leaves = 3001) {
  SpeciesSource source;
  source.name = generator;
  source.generator = generator;
  source.leaves = leaves;  // no multiple of 16 or 256
  return source;
}

std::uint32_t count_of(const Prototype& prototype, SurfaceClass surface) {
  std::uint32_t count = 0;
  for (const TriangleRun& run : prototype.runs) count += run.surface == surface ? run.count : 0;
  return count;
}

double distance_to_axis(const Stem& stem, const glm::dvec3& point) {
  double nearest = 1e30;
  for (std::size_t i = 0; i + 1 < stem.points.size(); ++i) {
    const glm::dvec3 edge = stem.points[i + 1] - stem.points[i];
    const double at = glm::clamp(glm::dot(point - stem.points[i], edge) / glm::dot(edge, edge), 0.0, 1.0);
    nearest = std::min(nearest, glm::distance(point, stem.points[i] + at * edge));
  }
  return nearest;
}

class EveryPreset : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Plants, EveryPreset, testing::Values("broadleaf", "conifer", "column", "shrub", "birch"),
                         [](const auto& test) { return test.param; });

TEST_P(EveryPreset, IsASoundPrototype) { expect_sound(build_species(source_of(GetParam()), seed, nullptr).prototype); }

TEST_P(EveryPreset, HasTheHeightAndTheLeavesAskedFor) {
  SpeciesSource source = source_of(GetParam(), 4999);
  source.height = 7.25;
  const Prototype plant = build_species(source, seed, nullptr).prototype;
  EXPECT_NEAR(plant.high.z, 7.25, 1e-4);
  EXPECT_LE(plant.low.z, 0);
  EXPECT_GT(plant.low.z, -0.05 * 7.25) << "only the trunk's foot is buried, a little";
  EXPECT_EQ(count_of(plant, SurfaceClass::leaf), 2u * 4999);
}

TEST_P(EveryPreset, KeepsItsLeafAreaWhenLeavesAreFewer) {
  const Prototype full = build_species(source_of(GetParam(), 0), seed, nullptr).prototype;
  const Prototype coarse = build_species(source_of(GetParam(), 5003), seed, nullptr).prototype;
  EXPECT_NEAR(coarse.crown.leaf_area / full.crown.leaf_area, 1, 0.1) << "larger leaves rise above the highest twig";
}

TEST_P(EveryPreset, LooksLikeAFieldPlantOfItsSize) {
  const Species species = build_species(source_of(GetParam(), 0), seed, nullptr);
  const Prototype& plant = species.prototype;
  const glm::vec3 size = plant.high - plant.low;
  const double ground = 0.25 * M_PI * size.x * size.y;  // of the crown's projection
  EXPECT_GT(plant.crown.leaf_area / ground, 1.5) << "leaf area index";
  EXPECT_LT(plant.crown.leaf_area / ground, 16) << "leaf area index; columns and conifers carry most";
  EXPECT_GT(plant.crown.plant_area, plant.crown.leaf_area);
  EXPECT_GE(plant.limbs.size(), 50u);
  EXPECT_LE(plant.limbs.size(), 400u);
  // Moore & Maguire 2004 and de Langre 2008; see presets.cpp.
  EXPECT_GT(species.trunk.frequency, 0.1);
  EXPECT_LT(species.trunk.frequency, species.branch.frequency);
  EXPECT_LT(species.branch.frequency, species.leaf.frequency);
}

TEST_P(EveryPreset, GrowsEveryStemFromItsParent) {
  const GrowthTraits& traits = find_preset(GetParam()).growth;
  const std::vector<Stem> stems = grow_skeleton(traits, seed);
  for (std::size_t i = 0; i < stems.size(); ++i) {
    ASSERT_LT(stems[i].parent, static_cast<std::int32_t>(i));
    if (stems[i].parent < 0) continue;
    const Stem& parent = stems[static_cast<std::size_t>(stems[i].parent)];
    ASSERT_EQ(stems[i].level, parent.level + 1);
    ASSERT_LT(distance_to_axis(parent, stems[i].points.front()), 1e-9);
    ASSERT_LE(stems[i].radii.front(), parent.radii.front());
    for (const glm::dvec3& point : stems[i].points) ASSERT_GT(point.z, 0) << "branches stay above ground";
  }
}

TEST_P(EveryPreset, HangsLimbsOnLimbs) {
  const Prototype plant = build_species(source_of(GetParam()), seed, nullptr).prototype;
  const double height = plant.high.z;
  for (const Limb& limb : plant.limbs) {
    if (limb.parent < 0) {
      EXPECT_EQ(limb.kind, SwayKind::trunk);
      EXPECT_NEAR(limb.base.z, 0, 0.02 * height);
      continue;
    }
    // The base lies inside the parent's wood: within its reach of its straight axis.
    const Limb& parent = plant.limbs[static_cast<std::size_t>(limb.parent)];
    const glm::vec3 offset = limb.base - parent.base;
    const float along = glm::dot(offset, parent.axis);
    EXPECT_LE(glm::length(offset - along * parent.axis), parent.reach + 1e-4 * height);
    EXPECT_GT(along, -0.02 * height);
    EXPECT_LT(along, parent.length + 0.02 * height);
    EXPECT_GE(limb.flexibility, 0.5f);
    EXPECT_LE(limb.flexibility, 2.0f);
  }
}

TEST_P(EveryPreset, IsAFunctionOfSpeciesVariantAndSeed) {
  SpeciesSource source = source_of(GetParam());
  const Prototype first = build_species(source, seed, nullptr).prototype;
  const Prototype again = build_species(source, seed, nullptr).prototype;
  EXPECT_EQ(first.vertices.x, again.vertices.x);
  EXPECT_EQ(first.vertices.flutter_z, again.vertices.flutter_z);
  EXPECT_EQ(first.triangles, again.triangles);
  EXPECT_NE(first.vertices.x, build_species(source, seed + 1, nullptr).prototype.vertices.x);
  source.variant = 1;
  EXPECT_NE(first.vertices.x, build_species(source, seed, nullptr).prototype.vertices.x);
}

TEST(Plants, FlutterGrowsFromThePetioleAlongTheLeafNormal) {
  SpeciesSource source = source_of("broadleaf", 997);
  const Prototype plant = build_species(source, seed, nullptr).prototype;
  for (const TriangleRun& run : plant.runs) {
    for (std::uint32_t t = run.first; t < run.first + run.count; ++t) {
      const std::uint32_t* corner = &plant.triangles[3 * t];
      const glm::vec3 base = position_of(plant, corner[0]);
      for (int k = 0; k < 3; ++k) {
        const glm::vec3 flutter = flutter_of(plant, corner[k]);
        if (run.surface == SurfaceClass::wood) {
          ASSERT_EQ(glm::length(flutter), 0) << "wood does not flutter";
          continue;
        }
        // 0.3 of the distance from the petiole's foot, which lies 8 % of the leaf's length behind its base.
        const float arm = glm::distance(position_of(plant, corner[k]), base);
        ASSERT_NEAR(glm::length(flutter), 0.3f * arm, 0.3f * 0.35f * plant.flutter_scale / 0.3f);
        ASSERT_EQ(plant.vertices.flutter_phase[corner[k]], plant.vertices.flutter_phase[corner[0]]);
      }
    }
  }
}

TEST(Plants, TallerOnesSwaySlower) {
  SpeciesSource source = source_of("broadleaf");
  source.height = 7;
  const Species small = build_species(source, seed, nullptr);
  source.height = 21;
  const Species tall = build_species(source, seed, nullptr);
  EXPECT_NEAR(small.trunk.frequency / tall.trunk.frequency, 3, 1e-3);
  source.trunk = SwayMode{2, 0.2, 0.3};
  EXPECT_EQ(build_species(source, seed, nullptr).trunk.frequency, 2) << "what the scene says wins";
}

TEST(Plants, RejectsWhatItCannotGrow) {
  const auto build = [](const SpeciesSource& source) { return [source] { build_species(source, seed, nullptr); }; };
  EXPECT_THAT(message_of(ErrorKind::invalid_input, build(source_of("palm"))),
              testing::AllOf(testing::HasSubstr("'palm'"), testing::HasSubstr("broadleaf, conifer, column")));
  EXPECT_THAT(message_of(ErrorKind::invalid_input, build(source_of("shrub", -3))), testing::HasSubstr("-3"));
}

TEST(RigidPrototype, GivesEveryNamedPartItsLimb) {
  RawMesh mesh;
  const std::vector<glm::vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.parts.push_back({"body", "paint", SurfaceClass::occluder, corners, {0, 1, 2}});
  mesh.parts.push_back({"wheel", "rubber", SurfaceClass::occluder, corners, {0, 2, 1}});
  mesh.parts.push_back({"body", "glass", SurfaceClass::occluder, corners, {0, 1, 2}});
  const Prototype parts = rigid_prototype("truck", mesh);
  expect_sound(parts);
  ASSERT_EQ(parts.limbs.size(), 2u);
  EXPECT_EQ(parts.limbs[0].kind, SwayKind::rigid);
  ASSERT_EQ(parts.runs.size(), 1u);
  EXPECT_EQ(parts.runs[0].surface, SurfaceClass::occluder);
  EXPECT_EQ(parts.vertices.block_limb, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(parts.crown.sphere_radius, 0) << "no crown";
  EXPECT_EQ(rigid_prototype("truck", mesh, false).limbs.size(), 1u);
  EXPECT_THAT(message_of(ErrorKind::invalid_input, [] { rigid_prototype("nothing", RawMesh{}); }),
              testing::HasSubstr("nothing"));
}

TEST(RigidPrototype, DropsTrianglesWithoutArea) {
  RawMesh mesh;
  mesh.parts.push_back(
      {"sheet", "", SurfaceClass::terrain, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}}, {0, 1, 2, 0, 1, 3}});
  const Prototype sheet = rigid_prototype("sheet", mesh);
  expect_sound(sheet);
  EXPECT_EQ(sheet.triangle_count(), 1u);
}

}  // namespace
}  // namespace understory
