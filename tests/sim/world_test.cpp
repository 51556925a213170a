// The concrete scene: tables that agree with each other, and what a scene does not need is not there.
#include "sim/world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "sim/dynamics.hpp"
#include "sim/terrain.hpp"
#include "tests/support/data.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/scenes.hpp"

namespace understory {
namespace {

const World& meadow() {
  static const World world = build_world(small_meadow());
  return world;
}

int count_role(const World& world, Instance::Role role) {
  return int(std::count_if(world.instances.begin(), world.instances.end(),
                           [&](const Instance& instance) { return instance.role == role; }));
}

TEST(World, HasWhatTheSceneSays) {
  const World& world = meadow();
  EXPECT_EQ(count_role(world, Instance::Role::terrain), 1);
  EXPECT_EQ(count_role(world, Instance::Role::plant), 8);
  EXPECT_EQ(count_role(world, Instance::Role::occluder), 2);
  EXPECT_EQ(world.prototypes.size(), 5u);
  ASSERT_EQ(world.grass.size(), 2u);
  EXPECT_NEAR(double(world.grass[0].size() + world.grass[1].size()), 2 * 26 * 50, 60);
  EXPECT_GT(world.ground_cover.columns, 10u);
}

TEST(World, EveryRunHasAnOwnerThatKnowsIt) {
  const World& world = meadow();
  ASSERT_GT(world.owners.size(), 1u);
  EXPECT_EQ(world.owners[0].surface, SurfaceClass::background);
  std::set<std::uint32_t> seen{0};
  for (std::size_t i = 0; i < world.instances.size(); ++i) {
    const Instance& instance = world.instances[i];
    const Prototype& prototype = world.prototypes[instance.prototype];
    ASSERT_EQ(instance.run_owner.size(), prototype.runs.size());
    std::uint32_t covered = 0;
    for (std::size_t run = 0; run < prototype.runs.size(); ++run) {
      const Owner& owner = world.owners.at(instance.run_owner[run]);
      EXPECT_EQ(owner.surface, prototype.runs[run].surface);
      EXPECT_EQ(owner.instance, int(i));
      EXPECT_EQ(owner.crown, instance.crown);
      EXPECT_EQ(prototype.runs[run].first, covered);
      covered += prototype.runs[run].count;
      seen.insert(instance.run_owner[run]);
    }
    EXPECT_EQ(covered, prototype.triangle_count());
  }
  for (const GrassBlades& blades : world.grass) {
    EXPECT_EQ(world.owners.at(blades.owner).surface, SurfaceClass::blade);
    seen.insert(blades.owner);
  }
  EXPECT_EQ(seen.size(), world.owners.size()) << "an owner owns nothing";
}

TEST(World, PlantsShareGroupAndCrownAndOccluderPartsDoNot) {
  const World& world = meadow();
  std::map<int, std::set<int>> groups_of_instance;
  std::map<int, std::set<int>> instances_of_group;
  std::set<int> crowns;
  for (const Owner& owner : world.owners) {
    if (owner.group < 0) continue;
    groups_of_instance[owner.instance].insert(owner.group);
    instances_of_group[owner.group].insert(owner.instance);
    if (owner.crown >= 0) crowns.insert(owner.crown);
  }
  for (const auto& [group, instances] : instances_of_group) EXPECT_EQ(instances.size(), 1u) << group;
  for (const auto& [instance, groups] : groups_of_instance) {
    const Instance& body = world.instances[instance];
    const std::size_t bodies =
        body.role == Instance::Role::occluder ? world.scene.occluders[body.occluder].parts.size() : 1u;
    EXPECT_EQ(groups.size(), bodies);
  }
  EXPECT_EQ(crowns.size(), 8u);
  EXPECT_EQ(*crowns.rbegin(), 7);
}

TEST(World, PlantsStandOnTheGroundAndSpheresBelongToParts) {
  const World& world = meadow();
  for (const Instance& instance : world.instances)
    if (instance.role == Instance::Role::plant) {
      EXPECT_EQ(instance.position.z, world.terrain->height_at(glm::dvec2(instance.position)));
    }
  ASSERT_GE(world.occluder_spheres.size(), 3u);
  std::set<int> groups;
  for (const OccluderSphere& sphere : world.occluder_spheres) {
    EXPECT_EQ(world.instances.at(sphere.instance).role, Instance::Role::occluder);
    EXPECT_GT(sphere.radius, 0);
    groups.insert(sphere.group);
  }
  EXPECT_EQ(groups.size(), 3u);
}

TEST(World, HoldsNothingThatTheSceneDoesNotNeed) {
  Scene scene = one_plant(small_species("shrub"));
  scene.species.push_back(small_species("conifer"));  // never placed
  scene.has_terrain = false;
  const World world = build_world(scene);
  EXPECT_EQ(world.prototypes.size(), 1u);
  EXPECT_EQ(world.terrain, nullptr);
  EXPECT_TRUE(world.grass.empty());
  EXPECT_TRUE(world.ground_cover.visibility.empty());
  EXPECT_TRUE(world.occluder_spheres.empty());
  EXPECT_TRUE(world.dynamics->species[1].trunk.along.empty());
  EXPECT_EQ(world.instances.at(0).position.z, 0);
}

TEST(World, AnotherSpeciesMovesNoPlant) {
  Scene scene = small_meadow();
  scene.species.insert(scene.species.begin(), small_species("column"));
  PlantPlacement column;
  column.species = "column";
  column.spots.push_back({{30, 30}, 0, 1});
  scene.plants.insert(scene.plants.begin(), column);
  const World more = build_world(scene);
  std::vector<glm::dvec3> before, after;
  for (const Instance& instance : meadow().instances)
    if (instance.role == Instance::Role::plant) before.push_back(instance.position);
  for (const Instance& instance : more.instances)
    if (instance.role == Instance::Role::plant && instance.species != 0) after.push_back(instance.position);
  EXPECT_EQ(before, after);
}

TEST(World, SaysWhatIsWrong) {
  Scene beside = one_plant(small_species("shrub"), {500, 0});
  EXPECT_THAT(message_of(ErrorKind::invalid_input, [&] { build_world(beside); }),
              testing::HasSubstr("`shrub` at [500, 0]"));
  Scene nameless = one_plant(small_species("shrub"));
  nameless.plants[0].species = "shrubb";
  EXPECT_THAT(message_of(ErrorKind::invalid_input, [&] { build_world(nameless); }), testing::HasSubstr("`shrubb`"));
}

TEST(World, RealTruckHasThreePartsOfItsFileEach) {
  UNDERSTORY_NEEDS_DATA();
  Scene scene;
  OccluderSource truck;
  truck.name = "truck";
  truck.motion_record = data_folder() / "milk_truck/milk_truck_motion.csv";
  for (const char* name : {"body", "wheels_front", "wheels_rear"})
    truck.parts.push_back({name,
                           OccluderPart::Shape::mesh,
                           glm::dvec3(1),
                           data_folder() / "milk_truck/milk_truck_parts.obj",
                           name,
                           UpAxis::y,
                           1,
                           {},
                           {}});
  scene.occluders.push_back(truck);
  const World world = build_world(scene);
  EXPECT_EQ(world.prototypes.back().limbs.size(), 3u);
  EXPECT_EQ(world.prototypes.back().triangle_count(), 3624u);
  scene.occluders[0].parts[1].mesh_object = "wheel";
  EXPECT_THAT(message_of(ErrorKind::invalid_input, [&] { build_world(scene); }),
              testing::AllOf(testing::HasSubstr("occluders.0.parts.1"), testing::HasSubstr("wheels_front")));
}

}  // namespace
}  // namespace understory
