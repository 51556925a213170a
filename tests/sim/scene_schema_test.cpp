// The published JSON Schema is the decoder's own, and a standard validator agrees with the decoder about a corpus.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "sim/files/scene_file.hpp"
#include "tests/support/temporary_file.hpp"

namespace understory {
namespace {

bool schema_accepts(const std::string& text) {
  const nlohmann::json description = nlohmann::json::parse(scene_json_schema());
  valijson::Schema schema;
  valijson::SchemaParser().populateSchema(valijson::adapters::NlohmannJsonAdapter(description), schema);
  const nlohmann::json scene = nlohmann::json::parse(text);
  return valijson::Validator().validate(schema, valijson::adapters::NlohmannJsonAdapter(scene), nullptr);
}

bool decoder_accepts(const std::string& text) {
  return validate_scene(TemporaryFile("scene.json", text).path()).empty();
}

const std::string ground = R"("terrain": {"flat": {}})";
const std::string tree = R"("species": {"a": {"generator": "birch"}}, "plants": [{"species": "a", )";
const std::string box = R"("parts": [{"box": [1, 1, 1]}])";

const std::string accepted[] = {
    "{" + ground + R"(, "environment": {"map": "scene.json", "turn": -90, "gloss": 15}})",
    "{" + ground + "}",
    "{" + ground + R"(, "name": "x", "seed": 9223372036854775807, "origin": [1, 2.5, -3e5], "sky": "sphere"})",
    "{" + ground + R"(, "image": {"width": 16384, "height": 1}, "time": {"start": -1, "fps": 29.97, "frames": 1}})",
    "{" + ground + R"(, "camera": {"position": [1, 2, 3], "target": [0, 0, 0], "fov": 170, "near": 0.01}})",
    "{" + ground + R"(, "wind": {"speed": 0, "turbulence": 2, "direction": -360}})",
    "{" + ground + R"(, "wind": {"record": "scene.json", "record_height": 4, "direction": 3}})",
    "{" + ground + R"(, "methods": {"tree": "none", "crowns": "solid-angle-exact", "ambient": 1}})",
    "{" + tree + R"("spots": [{"at": [0, 0], "yaw": 3, "scale": 2}]}]})",
    "{" + tree + R"("scatter": {"region": {"low": [0, 0], "high": [9, 9]}, "count": 4, "scale": [1, 1]}}]})",
    R"({"species": {"a": {"mesh": "scene.json", "up": "z", "leaf_materials": ["x*"], "height": 3}},
        "plants": [{"species": "a", "spots": [{"at": [0, 0]}]}]})",
    R"({"species": {"a": {"generator": "shrub", "leaves": 9, "variant": 3, "alpha_rho": 0.5,
        "sway": {"leaf": {"frequency": 3, "damping": 0.1, "deflection": 30}}}}, )" +
        ground + "}",
    R"({"grass": [{"region": {"low": [0, 0], "high": [1, 1]}, "height": {"mean": 1}, "albedo": [0, 0, 1]}]})",
    R"({"occluders": [{"name": "a", "loop": true, )" + box + R"(, "keyframes": [{"time": 0}, {"time": 1}]}]})",
    R"({"occluders": [{"name": "a", "motion": {"record": "scene.json", "up": "z"}, )" + box + "}]}",
    R"({"occluders": [{"name": "a", "parts": [{"mesh": "scene.json", "object": "b", "scale": 2}]}]})",
    R"({"occluders": [{"name": "a", "generator": "walker", "height": 1.7, "keyframes": [{"time": 0}, {"time": 1}]}]})",
    R"({"terrain": {"raster": {"file": "scene.json", "height": 3}, "albedo": [1, 1, 1]}})",
    R"({"terrain": "none", "occluders": [{"name": "a", )" + box + "}]}",
};

const std::string refused[] = {
    "{" + ground + R"(, "environment": {"turn": 10}})",
    "{" + ground + R"(, "environment": {"map": "scene.json", "gloss": 91}})",
    R"({"occluders": [{"name": "a"}]})",
    R"({"occluders": [{"name": "a", "generator": "walker", )" + box + "}]}",
    R"({"occluders": [{"name": "a", "height": 1.7, )" + box + "}]}",
    R"({"occluders": [{"name": "a", "generator": "walker", "motion": {"record": "scene.json"}}]})",
    "{}",
    "[]",
    R"({"terrain": "none"})",
    R"({"terrain": "none", "plants": [], "grass": []})",
    R"({"terrain": "flat"})",
    R"({"terrain": {"flat": {}, "mesh": {"file": "scene.json"}}})",
    R"({"terrain": {"albedo": [0, 0, 0]}})",
    R"({"terrain": {"raster": {}}})",
    R"({"terrain": {"raster": {"file": ""}}})",
    "{" + ground + R"(, "extra": 1})",
    "{" + ground + R"(, "name": 5})",
    "{" + ground + R"(, "name": ""})",
    "{" + ground + R"(, "seed": -1})",
    "{" + ground + R"(, "seed": "1"})",
    "{" + ground + R"(, "seed": 1.5})",
    "{" + ground + R"(, "seed": null})",
    "{" + ground + R"(, "origin": [1, 2]})",
    "{" + ground + R"(, "origin": [1, 2, "3"]})",
    "{" + ground + R"(, "origin": [1, 2, 3, 4]})",
    "{" + ground + R"(, "sky": "doom"})",
    "{" + ground + R"(, "image": {"width": 0}})",
    "{" + ground + R"(, "image": {"width": 16385}})",
    "{" + ground + R"(, "time": {"fps": 0}})",
    "{" + ground + R"(, "camera": {"fov": 171}})",
    "{" + ground + R"(, "wind": []})",
    "{" + ground + R"(, "wind": {"speed": -1}})",
    "{" + ground + R"(, "wind": {"record": "scene.json", "speed": 3}})",
    "{" + ground + R"(, "wind": {"record_height": 3}})",
    "{" + ground + R"(, "methods": {"tree": "magic"}})",
    "{" + ground + R"(, "species": {"1a": {"generator": "birch"}}})",
    "{" + ground + R"(, "species": {"a": {"generator": "bush"}}})",
    "{" + ground + R"(, "species": {"a": {}}})",
    "{" + ground + R"(, "species": {"a": {"generator": "birch", "mesh": "scene.json"}}})",
    "{" + ground + R"(, "species": {"a": {"generator": "birch", "up": "z"}}})",
    "{" + ground + R"(, "species": {"a": {"mesh": "scene.json", "leaves": 4}}})",
    "{" + ground + R"(, "species": {"a": {"generator": "birch", "height": 0}}})",
    "{" + ground + R"(, "species": {"a": {"generator": "birch", "sway": {"leaf": {"frequency": 3}}}}})",
    "{" + tree + R"("spots": []}]})",
    "{" + tree + R"("spots": [{"yaw": 3}]}]})",
    "{" + tree + R"("scatter": {}}]})",
    "{" + tree + R"("spots": [{"at": [0, 0]}], "scatter": {"region": {"low": [0, 0], "high": [9, 9]}}}]})",
    R"({"plants": [{"spots": [{"at": [0, 0]}]}]})",
    R"({"grass": [{}]})",
    R"({"grass": {"region": {"low": [0, 0], "high": [1, 1]}}})",
    R"({"grass": [{"region": {"low": [0, 0]}}]})",
    R"({"grass": [{"region": {"low": [0, 0], "high": [1, 1]}, "albedo": [0, 0, 1.5]}]})",
    R"({"occluders": [{"name": "a", "parts": []}]})",
    R"({"occluders": [{)" + box + "}]}",
    R"({"occluders": [{"name": "a", "loop": "true", )" + box + "}]}",
    R"({"occluders": [{"name": "a", "loop": 1, )" + box + "}]}",
    R"({"occluders": [{"name": "a", "parts": [{"box": [1, 1, 0]}]}]})",
    R"({"occluders": [{"name": "a", "parts": [{"box": [1, 1, 1], "ellipsoid": [1, 1, 1]}]}]})",
    R"({"occluders": [{"name": "a", "parts": [{"box": [1, 1, 1], "object": "x"}]}]})",
    R"({"occluders": [{"name": "a", "motion": {}, )" + box + "}]}",
    R"({"occluders": [{"name": "a", "keyframes": [{"position": [0, 0, 0]}], )" + box + "}]}",
};

TEST(SceneSchema, AgreesWithTheDecoder) {
  for (const std::string& text : accepted) {
    EXPECT_TRUE(schema_accepts(text)) << text;
    EXPECT_TRUE(decoder_accepts(text)) << text;
  }
  for (const std::string& text : refused) {
    EXPECT_FALSE(schema_accepts(text)) << text;
    EXPECT_FALSE(decoder_accepts(text)) << text;
  }
}

TEST(SceneSchema, AcceptsResolvedScenes) {
  for (const char* name : {"sim/scenes/tiny.yaml", "sim/scenes/meadow.yaml"}) {
    const Scene scene = load_scene(std::filesystem::path(UNDERSTORY_SOURCE_FOLDER) / name);
    EXPECT_TRUE(schema_accepts(resolved_scene(scene))) << name;
  }
}

TEST(SceneSchema, PublishedFileIsCurrent) {
  std::ifstream stream(std::filesystem::path(UNDERSTORY_SOURCE_FOLDER) / "sim/scenes/scene.schema.json");
  const std::string published(std::istreambuf_iterator<char>(stream), {});
  const auto current = std::filesystem::temp_directory_path() / "scene.schema.json";
  if (published != scene_json_schema()) {
    std::ofstream(current) << scene_json_schema();
    FAIL() << "the table of keys has changed: copy " << current << " over sim/scenes/scene.schema.json";
  }
}

TEST(SceneSchema, HelpNamesKeysRangesAndDefaults) {
  const std::string help = scene_help();
  EXPECT_THAT(help, testing::ContainsRegex("wind\\.speed +number 0 to 100 +mean speed at `height` \\[m/s\\] \\(4\\)"));
  EXPECT_THAT(help, testing::HasSubstr("occluders.N.parts.N.keyframes.N.rotation"));
}

}  // namespace
}  // namespace understory
