// What people write comes out as the Scene they mean, and every mistake is named with place, key, value and remedy.
#include "sim/files/scene_file.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <glm/gtc/constants.hpp>
#include <random>

#include "tests/support/errors.hpp"
#include "tests/support/temporary_file.hpp"

namespace understory {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

const std::filesystem::path source_folder = UNDERSTORY_SOURCE_FOLDER;

Scene load(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return load_scene(TemporaryFile("scene.yaml", text).path(), overrides);
}

std::vector<std::string> problems(const std::string& text, const std::vector<std::string>& overrides = {},
                                  const std::string& name = "scene.yaml") {
  return validate_scene(TemporaryFile(name, text).path(), overrides);
}

TEST(SceneFile, ReadsEachKindOfValue) {
  const Scene scene = load(R"(
name: "a: test"
seed: 9223372036854775807
origin: [500000.25, 5.2e6, 300]
sky: sphere
camera: {position: [0, -1e1, .5], target: [0, 0, 1], fov: 60}
terrain: none
wind: {direction: -90}
species: {elm: {generator: broadleaf, leaves: 12, sway: {leaf: {frequency: 5, damping: 0.1, deflection: 45}}}}
plants: [{species: elm, spots: [{at: [1, 2], yaw: 180}]}]
grass: [{region: {low: [0, 0], high: [1, 1]}, height: {mean: 0.5}, albedo: [0.1, 0.2, 1]}]
occluders:
  - name: cart
    on_terrain: false
    loop: true
    parts: [{name: box, box: [1, 2, 3]}, {capsule: [0.1, 0.1, 1]}]
    keyframes: [{time: 0, rotation: [0, 0, 90]}, {time: 1.5, position: [1, 0, 0]}]
)");
  EXPECT_EQ(scene.name, "a: test");
  EXPECT_EQ(scene.seed, 9223372036854775807u);
  EXPECT_EQ(scene.origin, glm::dvec3(500000.25, 5200000, 300));
  EXPECT_EQ(scene.sky, Sky::sphere);
  EXPECT_EQ(scene.camera.position, glm::dvec3(0, -10, 0.5));
  EXPECT_DOUBLE_EQ(scene.camera.vertical_fov, glm::pi<double>() / 3);
  EXPECT_FALSE(scene.has_terrain);
  EXPECT_DOUBLE_EQ(scene.wind.direction, -glm::half_pi<double>());
  EXPECT_EQ(scene.species.at(0).name, "elm");
  EXPECT_EQ(scene.species[0].leaves, 12);
  EXPECT_FALSE(scene.species[0].trunk.has_value());
  EXPECT_DOUBLE_EQ(scene.species[0].leaf.value().deflection, glm::quarter_pi<double>());
  EXPECT_FALSE(scene.plants.at(0).scatter);
  EXPECT_DOUBLE_EQ(scene.plants[0].spots.at(0).yaw, glm::pi<double>());
  EXPECT_EQ(scene.grass.at(0).height.mean, 0.5);
  EXPECT_EQ(scene.grass[0].height.deviation, GrassField{}.height.deviation);
  EXPECT_EQ(scene.grass[0].albedo, glm::vec3(0.1f, 0.2f, 1));
  const OccluderSource& cart = scene.occluders.at(0);
  EXPECT_TRUE(cart.loop && !cart.on_terrain);
  EXPECT_EQ(cart.parts.at(0).size, glm::dvec3(1, 2, 3));
  EXPECT_EQ(cart.parts.at(1).shape, OccluderPart::Shape::capsule);
  EXPECT_DOUBLE_EQ(cart.keyframes.at(0).rotation.z, glm::half_pi<double>());
}

TEST(SceneFile, LeavesDefaultsAlone) {
  const Scene scene = load("terrain: {flat: {}}");
  EXPECT_EQ(scene.name, "scene");  // from the file's name
  EXPECT_EQ(scene.image.width, ImageSize{}.width);
  EXPECT_EQ(scene.wind.speed, WindSource{}.speed);
  EXPECT_EQ(scene.terrain.kind, TerrainSource::Kind::flat);
}

TEST(SceneFile, ReadsJsonWithTabs) {
  const TemporaryFile file("scene.json", "{\n\t\"terrain\": {\"flat\": {}},\n\t\"image\": {\t\"width\": 7}\n}\n");
  EXPECT_EQ(load_scene(file.path()).image.width, 7);
}

TEST(SceneFile, ResolvesPathsAgainstItsFolderAndTheEnvironment) {
  const TemporaryFile mesh("plant.ply", "any");
  const TemporaryFile scene("scene.yaml",
                            "species: {a: {mesh: '${UNDERSTORY_TEST_FOLDER}/plant.ply'}}\n"
                            "plants: [{species: a, spots: [{at: [0, 0]}]}]\nwind: {record: ../" +
                                mesh.path().parent_path().filename().string() + "/plant.ply}\n");
  unsetenv("UNDERSTORY_TEST_FOLDER");
  EXPECT_THAT(validate_scene(scene.path()),
              ElementsAre(AllOf(HasSubstr("scene.yaml:1:21: species.a.mesh: "),
                                HasSubstr("environment variable UNDERSTORY_TEST_FOLDER is not set"))));
  setenv("UNDERSTORY_TEST_FOLDER", mesh.path().parent_path().c_str(), 1);
  const Scene loaded = load_scene(scene.path());
  unsetenv("UNDERSTORY_TEST_FOLDER");
  EXPECT_EQ(loaded.species.at(0).mesh, mesh.path());
  EXPECT_EQ(loaded.species[0].up, UpAxis::z);  // a PLY's usual axis
  EXPECT_EQ(loaded.wind.record, mesh.path());
}

struct Mistake {
  const char* name;
  const char* text;
  const char* place_and_key;
  const char* value;
  const char* allowed;
};

const Mistake mistakes[] = {
    {"unknown_key", "terrain: {flat: {}}\nwind:\n  sped: 4\n", ":3:3: wind.sped", "unknown key",
     "did you mean 'speed'?"},
    {"unknown_without_hint", "terrain: {flat: {}}\nzzzzzz: 1\n", ":2:1: zzzzzz", "unknown key",
     "allowed: name, seed, origin, sky, time, image, camera, terrain, wind"},
    {"duplicate_key", "terrain: {flat: {}}\nseed: 1\nseed: 2\n", ":3:1: seed", "duplicate key", "scene.yaml:2:1"},
    {"merge_key", "terrain: &a {flat: {}}\nwind: {<<: *a}\n", ":2:8: wind.<<", "unknown key", "allowed: speed"},
    {"leading_zero", "terrain: {flat: {}}\nseed: 010\n", ":2:7: seed: 010", "",
     "a whole number from 0 to 9223372036854775807"},
    {"leading_zero_real", "terrain: {flat: {}}\nwind: {speed: 010}\n", "wind.speed: 010", "", "from 0 to 100 m/s"},
    {"underscores", "terrain: {flat: {}}\nseed: 1_000\n", "seed: 1_000", "", "a whole number"},
    {"hexadecimal", "terrain: {flat: {}}\nseed: 0x10\n", "seed: 0x10", "", "a whole number"},
    {"quoted_number", "terrain: {flat: {}}\nseed: \"1\"\n", "seed: \"1\"", "", "a whole number"},
    {"fraction", "terrain: {flat: {}}\ntime: {frames: 1.5}\n", "time.frames: 1.5", "",
     "a whole number from 1 to 1000000"},
    {"not_a_number", "terrain: {flat: {}}\nwind: {speed: .nan}\n", "wind.speed: .nan", "", "a number from 0"},
    {"nan", "terrain: {flat: {}}\nwind: {speed: nan}\n", "wind.speed: nan", "", "a number from 0"},
    {"infinite", "terrain: {flat: {}}\nwind: {speed: 1e999}\n", "wind.speed: 1e999", "", "a number from 0"},
    {"below_range", "terrain: {flat: {}}\nwind: {speed: -3}\n", ":2:15: wind.speed: -3", "", "from 0 to 100 m/s"},
    {"zero_not_allowed", "terrain: {flat: {}}\ntime: {fps: 0}\n", "time.fps: 0", "", "above 0 up to"},
    {"no_image", "terrain: {flat: {}}\nimage: {width: 0}\n", "image.width: 0", "", "a whole number from 1 to 16384"},
    {"absurd_image", "terrain: {flat: {}}\nimage: {height: 16385}\n", "image.height: 16385", "", "from 1 to 16384"},
    {"beyond_63_bits", "terrain: {flat: {}}\nseed: 9223372036854775808\n", "seed: 9223372036854775808", "",
     "a whole number"},
    {"yes_is_no_flag", "occluders: [{name: a, parts: [{box: [1, 1, 1]}], loop: yes}]", "occluders.0.loop: yes", "",
     "true or false"},
    {"off_is_no_flag", "occluders: [{name: a, parts: [{box: [1, 1, 1]}], loop: off}]", "occluders.0.loop: off", "",
     "true or false"},
    {"quoted_flag", "occluders: [{name: a, parts: [{box: [1, 1, 1]}], loop: 'true'}]", "loop: \"true\"", "",
     "true or false"},
    {"number_as_name", "terrain: {flat: {}}\nname: 5\n", ":2:7: name: 5", "", "text of 1 to 200 bytes, in quotes"},
    {"flag_as_name", "terrain: {flat: {}}\nname: true\n", "name: true", "", "in quotes"},
    {"empty_name", "terrain: {flat: {}}\nname: ''\n", "name: \"\"", "", "text of 1 to 200 bytes"},
    {"map_for_number", "terrain: {flat: {}}\nseed: {a: 1}\n", "seed: a map", "", "a whole number"},
    {"number_for_map", "terrain: {flat: {}}\nwind: 4\n", "wind: 4", "", "a map of keys"},
    {"list_for_map", "terrain: {flat: {}}\nwind: [4]\n", "wind: a list of 1", "", "a map of keys"},
    {"map_for_list", "grass: {region: 1}\n", "grass: a map", "", "a list"},
    {"no_value", "terrain: {flat: {}}\nwind:\n", "wind: no value", "", "a map of keys"},
    {"too_few_numbers", "terrain: {flat: {}}\norigin: [1, 2]\n", ":2:9: origin: a list of 2", "",
     "a list of 3 numbers"},
    {"word_in_vector", "terrain: {flat: {}}\norigin: [1, x, 3]\n", ":2:13: origin.1: x", "", "a number from"},
    {"far_away", "terrain: {flat: {}}\ncamera: {position: [1e9, 0, 0]}\n", "camera.position.0: 1e9", "", "m"},
    {"unknown_word", "terrain: {flat: {}}\nsky: doom\n", ":2:6: sky: doom", "",
     "did you mean 'dome'? allowed: dome, sphere"},
    {"unknown_method", "terrain: {flat: {}}\nmethods: {tree: sphere_cap}\n", "methods.tree: sphere_cap", "",
     "did you mean 'sphere-cap'?"},
    {"two_terrains", "terrain: {flat: {}, raster: {file: x}}\n", "terrain: flat and raster are given together", "",
     "exactly one of: flat, raster, mesh"},
    {"no_kind_of_terrain", "terrain: {albedo: [0, 0, 0]}\n", "terrain: none of these keys is given", "",
     "exactly one of: flat, raster, mesh"},
    {"terrain_as_word", "terrain: flat\n", "terrain: flat", "", "'none' or a map"},
    {"missing_raster", "terrain: {raster: {file: no.tif}}\n", ":1:26: terrain.raster.file: no.tif", "",
     "there is no such file: /"},
    {"missing_key", "plants: [{spots: [{at: [0, 0]}]}]\n", ":1:10: plants.0.species: missing", "", "required"},
    {"unknown_species", "species: {birch: {generator: birch}}\nplants: [{species: brich, spots: [{at: [0, 0]}]}]\n",
     ":2:20: plants.0.species: brich", "", "did you mean 'birch'?"},
    {"no_species", "plants: [{species: oak, spots: [{at: [0, 0]}]}]\n", "plants.0.species: oak", "",
     "a name from 'species', which is empty"},
    {"spots_and_scatter",
     "species: {a: {generator: birch}}\nplants: [{species: a, spots: [{at: [0, 0]}], scatter: {region: {low: [0, 0], "
     "high: [1, 1]}}}]\n",
     "plants.0: spots and scatter are given together", "", "exactly one of"},
    {"leaves_of_a_mesh", "species: {a: {mesh: a.ply, leaves: 3}}\nterrain: {flat: {}}\n", "species.a.leaves: given", "",
     "allowed only beside 'generator'"},
    {"half_a_mode", "species: {a: {generator: birch, sway: {trunk: {frequency: 1}}}}\nterrain: {flat: {}}\n",
     "species.a.sway.trunk.damping: missing", "", "required"},
    {"odd_name", "species: {a b: {generator: birch}}\nterrain: {flat: {}}\n", ":1:11: species.a b: not a name", "",
     "letters, digits"},
    {"wind_twice", "terrain: {flat: {}}\nwind: {record: scene.yaml, speed: 4}\n", "wind.speed: given", "",
     "not allowed beside 'record'"},
    {"wind_in_the_canopy", "terrain: {flat: {}}\nwind: {height: 5, displacement: 5}\n", "wind.height: 5", "",
     "above displacement + roughness"},
    {"region_inside_out", "grass: [{region: {low: [1, 0], high: [0, 1]}}]\n", "grass.0.region.high", "",
     "greater than low in x and y"},
    {"eye_in_target", "terrain: {flat: {}}\ncamera: {position: [0, 0, 2], target: [0, 0, 2]}\n", "camera.target", "",
     "a point other than position"},
    {"time_runs_back", "occluders: [{name: a, parts: [{box: [1, 1, 1]}], keyframes: [{time: 1}, {time: 1}]}]\n",
     "occluders.0.keyframes", "", "times that increase"},
    {"same_name_twice", "occluders: [{name: a, parts: [{box: [1, 1, 1]}]}, {name: a, parts: [{box: [1, 1, 1]}]}]\n",
     "occluders", "", "a name of its own for each occluder"},
    {"no_parts", "occluders: [{name: a, parts: []}]\n", "occluders.0.parts: a list of 0", "", "a list of 1 or more"},
    {"rays_without_normals", "terrain: {flat: {}}\nmethods: {near: screen-rays, near_field: {normals: none}}\n",
     "methods.near: screen-rays", "", "near_field.normals buffer or depth"},
    {"rays_with_a_falloff", "terrain: {flat: {}}\nmethods: {near: screen-rays, near_field: {falloff: quadratic}}\n",
     "methods.near: screen-rays", "", "near_field.falloff constant"},
    {"rays_of_two_lengths", "terrain: {flat: {}}\nmethods: {near: screen-rays, near_field: {second_radius: 1}}\n",
     "methods.near: screen-rays", "", "without near_field.second_radius"},
    {"too_many_rays", "terrain: {flat: {}}\nmethods: {near: screen-rays, near_field: {samples: 65}}\n",
     "methods.near_field.samples: 65", "", "64"},
    {"empty_scene", "name: nothing\nterrain: none\nplants: []\n", ":1:1: scene: nothing to see", "",
     "at least one of: terrain, plants, grass, occluders"},
};

class SceneMistake : public testing::TestWithParam<Mistake> {};

TEST_P(SceneMistake, IsNamed) {
  const Mistake& mistake = GetParam();
  EXPECT_THAT(problems(mistake.text),
              testing::Contains(AllOf(HasSubstr("scene.yaml:"), HasSubstr(mistake.place_and_key),
                                      HasSubstr(mistake.value), HasSubstr(mistake.allowed))));
  const std::string thrown = message_of(ErrorKind::invalid_input, [&] { load(mistake.text); });
  EXPECT_EQ(thrown.find('\n'), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(All, SceneMistake, testing::ValuesIn(mistakes),
                         [](const auto& mistake) { return std::string(mistake.param.name); });

TEST(SceneFile, ListsAllMistakesInOrder) {
  EXPECT_THAT(problems("image: {width: 0}\nseed: x\nterrain: {flat: {}}\nwind: {sped: 1, height: -1}\n"),
              ElementsAre(HasSubstr(":1:16: image.width"), HasSubstr(":2:7: seed"), HasSubstr(":4:8: wind.sped"),
                          HasSubstr(":4:25: wind.height")));
  EXPECT_THAT(message_of(ErrorKind::invalid_input, [] { load("seed: x\nsky: y\nterrain: {flat: {}}\n"); }),
              AllOf(HasSubstr("seed: x"), HasSubstr("and 1 more")));
}

TEST(SceneFile, NamesBrokenSyntax) {
  EXPECT_THAT(problems("terrain: {flat: {}\nseed: 1\n"), ElementsAre(HasSubstr("not valid YAML")));
  EXPECT_THAT(problems("a: 1\n\tb: 2\n"), ElementsAre(AllOf(HasSubstr("scene.yaml:2:"), HasSubstr("not valid YAML"))));
  EXPECT_THAT(problems("terrain: {flat: {}}\n---\nseed: 1\n"), ElementsAre(HasSubstr("two documents")));
  EXPECT_THAT(problems("seed: !!int 1\n"), ElementsAre(AllOf(HasSubstr(":1:7"), HasSubstr("tags are not allowed"))));
  EXPECT_THAT(problems("- 1\n"), ElementsAre(HasSubstr("must be a map")));
  EXPECT_THAT(problems("{\n  \"seed\": 1,\n}\n", {}, "scene.json"),
              ElementsAre(AllOf(HasSubstr("scene.json:3:1"), HasSubstr("not valid JSON"))));
  EXPECT_THAT(problems(""), ElementsAre(HasSubstr("nothing to see")));
  EXPECT_THAT(problems(std::string("seed: 1\nname: \0x\n", 17)), ElementsAre(HasSubstr("text in UTF-8")));
  EXPECT_THAT(message_of(ErrorKind::invalid_input, [] { load_scene("/no/such/scene.yaml"); }),
              HasSubstr("/no/such/scene.yaml: there is no such file"));
  EXPECT_THAT(message_of(ErrorKind::invalid_input, [] { load_scene("/tmp"); }), HasSubstr("not a file"));
}

TEST(SceneFile, BoundsWhatAHostileFileCosts) {
  const TemporaryFile huge("scene.yaml", "");
  std::filesystem::resize_file(huge.path(), std::uintmax_t{1} << 40);  // sparse
  EXPECT_THAT(validate_scene(huge.path()), ElementsAre(HasSubstr("a scene file may have 16777216 at most")));

  std::string laughs = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 12; ++i) {
    const std::string last = "*a" + std::to_string(i - 1);
    laughs += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + last;
    for (int k = 1; k < 10; ++k) laughs += ", " + last;
    laughs += "]\n";
  }
  EXPECT_THAT(problems(laughs), ElementsAre(HasSubstr("no more are allowed")));
  EXPECT_THAT(problems("a: &a [*a]\n"), ElementsAre(HasSubstr("stands for itself")));
  EXPECT_THAT(problems("a: " + std::string(100000, '[')), ElementsAre(HasSubstr("nested too deeply")));
  EXPECT_THAT(problems("a: " + std::string(100000, '['), {}, "scene.json"), SizeIs(1));

  std::string many = "terrain: {flat: {}}\n";
  for (int i = 0; i < 5000; ++i) many += "unknown" + std::to_string(i) + ": 1\n";
  EXPECT_THAT(problems(many), SizeIs(200));
}

TEST(SceneFile, AliasesStandForTheirAnchors) {
  const Scene scene =
      load("grass:\n  - &one {region: {low: [0, 0], high: [1, 1]}, density: 9}\n  - *one\n", {"grass.1.density=5"});
  EXPECT_EQ(scene.grass.at(0).density, 9);  // an override changes one use of an alias, not the other
  EXPECT_EQ(scene.grass.at(1).density, 5);
  EXPECT_EQ(scene.grass.at(1).region.high.x, 1);
}

TEST(SceneOverrides, SetAddAndRemove) {
  const std::string text = "terrain: {flat: {}}\noccluders: [{name: a, parts: [{box: [1, 1, 1]}]}]\nwind: {speed: 3}\n";
  EXPECT_EQ(load(text, {"wind.speed=4.5"}).wind.speed, 4.5);
  EXPECT_EQ(load(text, {"wind.speed=null"}).wind.speed, WindSource{}.speed);
  EXPECT_EQ(load(text, {"camera.fov=90"}).camera.vertical_fov, glm::half_pi<double>());
  EXPECT_EQ(load(text, {"occluders.0.name=ball"}).occluders.at(0).name, "ball");
  EXPECT_THAT(load(text, {"occluders.0=null"}).occluders, IsEmpty());
  EXPECT_EQ(load(text, {"occluders.1={name: b, parts: [{box: [1, 2, 1]}]}"}).occluders.at(1).parts.at(0).size.y, 2);
  EXPECT_EQ(load(text, {"seed=1", "seed=2"}).seed, 2u);
  EXPECT_EQ(load(text, {"name=x=y"}).name, "x=y");
}

TEST(SceneOverrides, AreNamedInMessages) {
  const std::string text = "terrain: {flat: {}}\noccluders: [{name: a, parts: [{box: [1, 1, 1]}]}]\n";
  EXPECT_THAT(problems(text, {"wind.speed=fast"}),
              ElementsAre("--set wind.speed=fast: wind.speed: fast: allowed is a number from 0 to 100 m/s"));
  EXPECT_THAT(problems(text, {"wind.sped=1"}),
              ElementsAre(AllOf(HasSubstr("--set wind.sped=1"), HasSubstr("did you mean 'speed'"))));
  EXPECT_THAT(problems(text, {"occluders.2.name=x"}), ElementsAre(HasSubstr("a list position from 0 to 1")));
  EXPECT_THAT(problems(text, {"occluders.first.name=x"}),
              ElementsAre(HasSubstr("'first': allowed is a list position")));
  EXPECT_THAT(problems(text, {"occluders.0.name.x=1"}), ElementsAre(HasSubstr("no keys below the value 'a'")));
  EXPECT_THAT(problems(text, {"nonsense"}), ElementsAre(HasSubstr("allowed is KEY=VALUE")));
  EXPECT_THAT(problems(text, {"seed="}), ElementsAre(HasSubstr("no value")));
  EXPECT_THAT(problems(text, {"seed=[1"}), ElementsAre(AllOf(HasSubstr("--set seed=[1"), HasSubstr("not valid YAML"))));
}

TEST(ResolvedScene, ReadsBackTheSame) {
  for (const char* name : {"sim/scenes/tiny.yaml", "sim/scenes/meadow.yaml", "bench/scenes/ecosystem.yaml"}) {
    const Scene scene = load_scene(source_folder / name, {"wind.direction=33.3", "origin=[500000.1, 0, 0.1]"});
    const std::string text = resolved_scene(scene);
    const Scene again = load_scene(TemporaryFile("resolved.json", text).path());
    EXPECT_EQ(resolved_scene(again), text) << name;
    EXPECT_EQ(again.wind.direction, scene.wind.direction) << name;  // bits, through degrees and back
    EXPECT_EQ(again.camera.vertical_fov, scene.camera.vertical_fov) << name;
    EXPECT_EQ(again.origin, scene.origin) << name;
    ASSERT_EQ(again.occluders.size(), scene.occluders.size());
    for (std::size_t i = 0; i < scene.occluders.size(); ++i) {
      for (std::size_t k = 0; k < scene.occluders[i].keyframes.size(); ++k) {
        EXPECT_EQ(again.occluders[i].keyframes[k].rotation, scene.occluders[i].keyframes[k].rotation);
      }
    }
  }
}

TEST(ResolvedScene, KeepsEveryAngleToTheBit) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> angle(-360, 360);
  Scene scene = load("terrain: {flat: {}}");
  for (int i = 0; i < 50; ++i) {
    const std::string degrees = std::to_string(angle(random));
    scene = load("terrain: {flat: {}}", {"wind.direction=" + degrees});
    const Scene again = load_scene(TemporaryFile("resolved.json", resolved_scene(scene)).path());
    EXPECT_EQ(again.wind.direction, scene.wind.direction) << degrees;
  }
}

TEST(ResolvedScene, IdentityDoesNotDependOnTheFolder) {
  const std::string text = "species: {a: {mesh: plant.ply}}\nplants: [{species: a, spots: [{at: [0, 0]}]}]\n";
  const auto identity = [&] {
    const TemporaryFile scene("scene.yaml", text);
    std::ofstream(scene.path().parent_path() / "plant.ply") << "any";
    return resolved_scene(load_scene(scene.path()), PathStyle::file_name);
  };
  EXPECT_EQ(identity(), identity());
}

TEST(SceneFile, SurvivesDamage) {
  std::ifstream stream(source_folder / "sim/scenes/tiny.yaml");
  const std::string whole(std::istreambuf_iterator<char>(stream), {});
  for (std::size_t size = 0; size < whole.size(); size += 3) static_cast<void>(problems(whole.substr(0, size)));
  std::mt19937 random(11);
  for (int round = 0; round < 400; ++round) {
    std::string damaged = whole;
    for (int k = 0; k < 3; ++k) damaged[random() % damaged.size()] = "{}[]:,&*#\n -\"'x0\t|>%@\xff"[random() % 22];
    static_cast<void>(problems(damaged));  // any answer, no crash and no other exception
    static_cast<void>(problems(damaged, {}, "scene.json"));
  }
}

TEST(Scenes, AreValid) {
  for (const char* name : {"sim/scenes/tiny.yaml", "sim/scenes/meadow.yaml", "bench/scenes/ecosystem.yaml",
                           "bench/scenes/single_tree.yaml"}) {
    EXPECT_THAT(validate_scene(source_folder / name), IsEmpty());
  }
}

TEST(Scenes, RealDataIsValid) {
  const char* data = std::getenv("UNDERSTORY_DATA");
  if (!data) GTEST_SKIP() << "needs real data: set UNDERSTORY_DATA to its folder";
  EXPECT_THAT(validate_scene(source_folder / "bench/scenes/real.yaml"), IsEmpty());
}

}  // namespace
}  // namespace understory
