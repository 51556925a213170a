// What a scene does not hold is not planned, not built, not allocated and not run.
#include "host/frame/plan.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "tests/support/errors.hpp"
#include "tests/support/frames.hpp"

namespace understory {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// What one frame of a scene took.
struct Taken {
  std::set<std::string> passes, programs;  // planned
  std::set<std::string> run, built;        // names in the timings, programs on the device
  std::uint64_t bytes = 0;
  Frame frame;
};

Taken render_one(const Scene& scene) {
  const World world = build_world(scene);
  Device device;
  FrameRunner runner(device, world);
  Taken taken;
  taken.frame = runner.render(0, 0.5);
  for (const PlannedPass& pass : runner.plan().passes) {
    EXPECT_FALSE(pass.because.empty()) << pass.name;
    EXPECT_EQ(pass.key.empty(), pass.because == "every frame") << pass.name << " was asked for by a key, or by none";
    taken.passes.insert(pass.name);
    taken.programs.insert(pass.program);
  }
  for (const auto& [name, milliseconds] : taken.frame.pass_ms) taken.run.insert(name);
  for (const std::string& program : device.programs_built()) taken.built.insert(program);
  taken.bytes = device.buffer_bytes();
  return taken;
}

/// Every planned pass ran and no other; every planned program was built and no other.
void expect_as_planned(const Taken& taken) {
  EXPECT_EQ(taken.run, taken.passes);
  std::set<std::string> planned = taken.programs;
  if (planned.contains("solid_angle")) planned.insert("tile_spheres");  // its first kernel
  EXPECT_EQ(taken.built, planned);
}

TEST(Plan, OfAFullSceneHoldsEveryKindOfPass) {
  const Taken taken = render_one(meadow_view());
  expect_as_planned(taken);
  EXPECT_THAT(taken.passes, testing::IsSupersetOf({"pose_mesh", "pose_grass", "rasterise_mesh", "rasterise_grass",
                                                   "resolve", "ambient", "sphere-cap", "grass-height", "open-dome",
                                                   "solid-angle-cosine", "combine"}));
}

TEST(Plan, WithoutGrassHasNoGrassProgramAndNoGrassBuffer) {
  Scene scene = meadow_view();
  const Taken with = render_one(scene);
  scene.grass.clear();
  const Taken without = render_one(scene);
  expect_as_planned(without);
  for (const std::set<std::string>* names : {&without.passes, &without.run, &without.built})
    EXPECT_THAT(*names, Not(Contains(HasSubstr("grass"))));
  EXPECT_THAT(without.passes, Not(Contains("ambient"))) << "the ground has no grass on it";
  EXPECT_THAT(without.frame.height_above_root, IsEmpty());
  EXPECT_EQ(with.frame.height_above_root.size(), with.frame.pixels());
  // Per blade 11 numbers at rest and 7 vertices of 3; two fields of 1300 to 1400 blades.
  EXPECT_GE(with.bytes - without.bytes, 2600u * (11 + 7 * 3) * sizeof(float));
}

TEST(Plan, WithGrassThatNoMethodAsksAboutHasNoHeights) {
  Scene scene = meadow_view();
  const std::uint64_t with_heights = render_one(scene).bytes;
  scene.methods.grass = "ambient";
  const Taken taken = render_one(scene);
  expect_as_planned(taken);
  EXPECT_THAT(taken.frame.height_above_root, IsEmpty());
  EXPECT_LT(taken.bytes, with_heights);
}

TEST(Plan, WithTheLightAmongGrassHasNoOtherModelOfItsGround) {
  Scene scene = meadow_view();
  scene.methods.grass = "grass-transmittance";
  const Taken taken = render_one(scene);
  expect_as_planned(taken);
  EXPECT_THAT(taken.passes, Contains("grass-transmittance"));
  EXPECT_THAT(taken.passes, Not(Contains("grass-height")));
  EXPECT_THAT(taken.passes, Not(Contains("ambient")));
  EXPECT_EQ(taken.frame.height_above_root.size(), taken.frame.pixels());
  scene.grass.clear();
  EXPECT_THAT(render_one(scene).built, Not(Contains(HasSubstr("grass"))));
}

TEST(Plan, WithoutPlantsHasNoCrownPass) {
  Scene scene = meadow_view();
  scene.species.clear();
  scene.plants.clear();
  scene.methods.crowns = "solid-angle-exact";
  const Taken taken = render_one(scene);
  expect_as_planned(taken);
  EXPECT_THAT(taken.built, Not(Contains("sphere_cap")));
  EXPECT_THAT(taken.passes, Not(Contains("solid-angle-exact")));
  EXPECT_THAT(taken.passes, Contains("solid-angle-cosine")) << "of the occluders";
}

TEST(Plan, KeepsRestPointsOnlyForTheFieldThatReadsThem) {
  Scene scene = meadow_view();
  const Taken without = render_one(scene);
  EXPECT_THAT(without.built, Not(Contains("crown_field")));
  scene.methods.tree = "crown-field";
  const Taken with = render_one(scene);
  expect_as_planned(with);
  EXPECT_THAT(with.built, Not(Contains("sphere_cap")));
  // Six planes of rest position and normal, and a field for each of two species.
  EXPECT_GE(with.bytes, without.bytes + 6 * with.frame.pixels() * sizeof(float));
  scene.species.clear();
  scene.plants.clear();
  const Taken bare = render_one(scene);
  expect_as_planned(bare);
  EXPECT_THAT(bare.built, Not(Contains("crown_field")));
}

TEST(Plan, KeepsTexelsOnlyForTheBakeThatReadsThem) {
  Scene scene = meadow_view();
  const Taken without = render_one(scene);
  EXPECT_THAT(without.built, Not(Contains("crown_baked")));
  scene.methods.tree = "crown-baked";
  const Taken with = render_one(scene);
  expect_as_planned(with);
  EXPECT_THAT(with.built, Not(Contains("sphere_cap")));
  EXPECT_GE(with.bytes, without.bytes + 2 * with.frame.pixels() * sizeof(std::uint32_t));
}

TEST(Plan, WithoutOccludersHasOnePassForCrowns) {
  Scene scene = meadow_view();
  scene.occluders.clear();
  scene.methods.occluders = "solid-angle-exact";
  const Taken taken = render_one(scene);
  expect_as_planned(taken);
  EXPECT_THAT(taken.passes, Not(Contains("solid-angle-exact")));
  scene.methods.crowns = "none";
  EXPECT_THAT(render_one(scene).built, Not(Contains("solid_angle")));
}

TEST(Plan, WithoutTerrainKnowsNoGround) {
  Scene scene = meadow_view();
  scene.has_terrain = false;
  const Taken taken = render_one(scene);
  expect_as_planned(taken);
  EXPECT_THAT(taken.passes, Not(Contains("ambient")));
}

TEST(Plan, OfGrassAloneHasNoMeshPass) {
  Scene scene = meadow_view();
  scene.has_terrain = false;
  scene.species.clear();
  scene.plants.clear();
  scene.occluders.clear();
  const Taken taken = render_one(scene);
  expect_as_planned(taken);
  EXPECT_THAT(taken.passes, Not(Contains(HasSubstr("mesh"))));
  EXPECT_THAT(taken.built, Not(Contains("pose_mesh")));
}

TEST(Plan, OfNothingDrawsTheBackground) {
  Scene scene = open_ground();
  scene.has_terrain = false;
  const Taken taken = render_one(scene);
  expect_as_planned(taken);
  for (std::size_t i = 0; i < taken.frame.pixels(); ++i) {
    EXPECT_TRUE(is_background(taken.frame, i));
    EXPECT_EQ(taken.frame.visibility[i], 1);
  }
}

TEST(Plan, UnderASphereOfSkyHasNoHorizon) {
  Scene scene = meadow_view();
  scene.sky = Sky::sphere;
  const Taken taken = render_one(scene);
  expect_as_planned(taken);
  EXPECT_THAT(taken.built, Not(Contains("open_dome")));
  EXPECT_FALSE(taken.frame.terms.contains("open-dome"));
}

TEST(Plan, OfTheNearFieldHoldsWhatItsOptionsAskFor) {
  Scene scene = meadow_view();
  const Taken without = render_one(scene);
  EXPECT_THAT(without.built, Not(Contains(HasSubstr("obscurance"))));
  scene.methods.near = "obscurance-point";
  const Taken plain = render_one(scene);
  expect_as_planned(plain);
  EXPECT_THAT(plain.built, Contains("obscurance_point"));
  EXPECT_THAT(plain.built, Not(Contains(HasSubstr("obscurance_blur"))));
  EXPECT_THAT(plain.built, Not(Contains(HasSubstr("normals_from_depth"))));
  scene.methods.near = "obscurance-area";
  const Taken area = render_one(scene);
  expect_as_planned(area);
  EXPECT_THAT(area.passes, testing::IsSupersetOf({"depth-moments", "obscurance-area"}));
  scene.methods.near = "screen-rays";
  const Taken rays = render_one(scene);
  expect_as_planned(rays);
  EXPECT_THAT(rays.built, Contains("screen_rays"));
  EXPECT_THAT(rays.built, Not(Contains(HasSubstr("obscurance"))));
  scene.methods.near = "obscurance-line";
  scene.methods.near_field.blur = 4;
  scene.methods.near_field.half_resolution = true;
  scene.methods.near_field.normals = "depth";
  const Taken taken = render_one(scene);
  expect_as_planned(taken);
  EXPECT_THAT(taken.passes, testing::IsSupersetOf({"obscurance-line", "obscurance-blur", "obscurance-half",
                                                   "obscurance-upsample", "normals-from-depth"}));
}

/// What a plan leaves out, each with a reason and the key that would bring it back.
std::set<std::string> left_out(const Scene& scene) {
  std::set<std::string> keys;
  for (const LeftOut& left : make_plan(build_world(scene), scene.methods).left_out) {
    EXPECT_FALSE(left.what.empty() || left.because.empty() || left.key.empty()) << left.what;
    keys.insert(left.what + "/" + left.key);
  }
  return keys;
}

TEST(Plan, SaysWhatItLeavesOutAndByWhichKeyItWouldComeBack) {
  Scene scene = meadow_view();
  EXPECT_THAT(left_out(scene), testing::UnorderedElementsAre("the near field/methods.near",
                                                             "coloured light of the sky/environment.map"));
  scene.methods.near = "obscurance-line";
  EXPECT_THAT(left_out(scene), testing::UnorderedElementsAre("coloured light of the sky/environment.map"));
  scene.methods.tree = scene.methods.crowns = "none";
  EXPECT_THAT(left_out(scene), testing::IsSupersetOf({"crowns on their own leaves and wood/methods.tree",
                                                      "crowns on everything else/methods.crowns"}));
  scene.plants.clear();
  scene.grass.clear();
  scene.sky = Sky::sphere;
  EXPECT_THAT(left_out(scene),
              testing::IsSupersetOf({"crowns on their own leaves and wood/plants", "crowns on everything else/plants",
                                     "posing and drawing of grass/grass", "grass on its own blades/grass",
                                     "the horizon of open surfaces/sky", "a constant/methods.tree"}));
}

TEST(Plan, OfAConstantNamesEverybodyWhoReadsIt) {
  Scene scene = meadow_view();
  scene.methods.tree = scene.methods.grass = "ambient";
  const Plan plan = make_plan(build_world(scene), scene.methods);
  const auto ambient = std::find_if(plan.passes.begin(), plan.passes.end(),
                                    [](const PlannedPass& pass) { return pass.name == "ambient"; });
  ASSERT_NE(ambient, plan.passes.end());
  EXPECT_EQ(ambient->because, "ground under grass, plants with a crown, grass");
  EXPECT_EQ(ambient->key, "grass, methods.tree, methods.grass");
}

/// Every frame takes these, whatever shades it: bodies are posed and drawn, planes resolved, terms combined.
std::set<std::string> beyond_every_frame(std::set<std::string> programs) {
  for (const char* program : {"pose_mesh", "rasterise", "resolve", "combine"}) programs.erase(program);
  return programs;
}

TEST(Plan, OfASceneThatNeedsOneMethodBuildsOneProgramForIt) {
  Scene plant = one_plant(small_species("birch"));
  plant.image = {31, 23};
  plant.has_terrain = false;
  plant.sky = Sky::sphere;
  const Taken tree = render_one(plant);
  expect_as_planned(tree);
  EXPECT_THAT(beyond_every_frame(tree.built), testing::ElementsAre("sphere_cap"));
  EXPECT_THAT(beyond_every_frame(render_one(open_ground()).built), testing::ElementsAre("open_dome"));
}

TEST(Plan, RefusesMethodsThatDoNotExist) {
  const World world = build_world(open_ground());
  Methods methods;
  methods.tree = "spherecap";
  const std::string message = message_of(ErrorKind::invalid_input, [&] { make_plan(world, methods); });
  EXPECT_THAT(message, HasSubstr("methods.tree"));
  EXPECT_THAT(message, HasSubstr("'spherecap'"));
  EXPECT_THAT(message, HasSubstr("ellipsoid-cap"));
  methods = {};
  methods.occluders = "gird";
  EXPECT_THAT(message_of(ErrorKind::invalid_input, [&] { make_visibility_plan(nullptr, methods); }),
              HasSubstr("methods.occluders"));
}

TEST(Plan, OfForeignPlanesWithoutASceneIsTheOpenDome) {
  const Plan plan = make_visibility_plan(nullptr, {});
  ASSERT_EQ(plan.passes.size(), 2u);
  EXPECT_TRUE(plan.has("open-dome"));
  EXPECT_TRUE(plan.has("combine"));
}

}  // namespace
}  // namespace understory
