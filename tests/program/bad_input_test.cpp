// Wrong scenes and wrong places: one clear message with file, line, key, value and what is allowed, the exit code of
// its kind, and nothing written.
#include "tests/program/program.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* terrain = "terrain: {flat: {height: 0}}\n";

struct BadScene {
  std::string name, text;
  std::vector<std::string> message_parts;  // file and line come with every message
  int line;
};

void PrintTo(const BadScene& scene, std::ostream* out) { *out << scene.name; }

class BadSceneTest : public testing::TestWithParam<BadScene> {};

TEST_P(BadSceneTest, IsRefusedByEveryCommandThatReadsOne) {
  const TemporaryFolder folder;
  const fs::path scene = folder / "scene.yaml", out = folder / "out";
  std::ofstream(scene) << GetParam().text;
  const std::string place = "scene.yaml:" + (GetParam().line > 0 ? std::to_string(GetParam().line) + ":" : "");
  for (const auto& arguments : {std::vector<std::string>{"validate", scene}, {"run", scene, "-o", out}}) {
    const FinishedProcess result = understory_command(arguments);
    EXPECT_EQ(result.exit_code, 3) << result.err;
    EXPECT_THAT(result.err, HasSubstr(place));
    for (const std::string& part : GetParam().message_parts) EXPECT_THAT(result.err, HasSubstr(part));
  }
  EXPECT_FALSE(fs::exists(out));
  const FinishedProcess json = understory_command({"validate", scene, "--json"});
  EXPECT_EQ(json.exit_code, 3);
  EXPECT_EQ(nlohmann::json::parse(json.out).at("valid"), false);
  EXPECT_GE(nlohmann::json::parse(json.out).at("errors").size(), 1u);
}

INSTANTIATE_TEST_SUITE_P(
    Corpus, BadSceneTest,
    testing::Values(
        BadScene{"malformed", std::string(terrain) + "wind: {speed: 3\n", {}, 0},
        BadScene{"unknown_key", std::string(terrain) + "wind: {sped: 3}\n", {"sped", "speed"}, 2},
        BadScene{"duplicate_key", std::string(terrain) + "seed: 1\nseed: 2\n", {"seed"}, 3},
        BadScene{"wrong_type", std::string(terrain) + "wind: {speed: fast}\n", {"speed", "fast"}, 2},
        BadScene{"out_of_range", std::string(terrain) + "wind: {speed: -4}\n", {"speed", "-4"}, 2},
        BadScene{"not_finite", std::string(terrain) + "wind: {speed: .nan}\n", {"speed"}, 2},
        BadScene{"zero_sized_image", std::string(terrain) + "image: {width: 0, height: 10}\n", {"width", "0"}, 2},
        BadScene{
            "absurd_image", std::string(terrain) + "image: {width: 10, height: 9999999}\n", {"height", "9999999"}, 2},
        BadScene{
            "unknown_method", std::string(terrain) + "methods: {tree: magic}\n", {"tree", "magic", "sphere-cap"}, 2},
        BadScene{"empty_file", "", {}, 0}, BadScene{"nothing_to_see", "terrain: none\n", {}, 0},
        BadScene{"missing_mesh",
                 std::string(terrain) +
                     "species:\n  oak: {mesh: oak.obj}\nplants: [{species: oak, spots: [{at: [0, 0]}]}]\n",
                 {"oak.obj"},
                 3}),
    [](const auto& corpus) { return corpus.param.name; });

struct BadMesh {
  std::string name, text, message_part;
};

void PrintTo(const BadMesh& mesh, std::ostream* out) { *out << mesh.name; }

class BadMeshTest : public testing::TestWithParam<BadMesh> {};

TEST_P(BadMeshTest, IsRefusedWithItsName) {
  const TemporaryFolder folder;
  std::ofstream(folder / "plant.obj") << GetParam().text;
  std::ofstream(folder / "scene.yaml") << terrain
                                       << "species: {oak: {mesh: plant.obj}}\n"
                                          "plants: [{species: oak, spots: [{at: [0, 0]}]}]\n";
  const FinishedProcess result = understory_command({"run", folder / "scene.yaml", "-o", folder / "out"});
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_THAT(result.err, IsOneMessageWith("plant.obj"));
  EXPECT_THAT(result.err, HasSubstr(GetParam().message_part));
  EXPECT_FALSE(fs::exists(folder / "out"));
}

INSTANTIATE_TEST_SUITE_P(Corpus, BadMeshTest,
                         testing::Values(BadMesh{"broken", "not a mesh at all", ""},
                                         BadMesh{"without_faces", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "face"},
                                         BadMesh{"nan_vertex", "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n", ""}),
                         [](const auto& corpus) { return corpus.param.name; });

TEST(BadInput, NamesASceneThatIsNotThere) {
  const FinishedProcess result = understory_command({"run", "nowhere.yaml", "-o", "out"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, IsOneMessageWith("nowhere.yaml"));
}

TEST(BadInput, TellsEveryErrorOfAScene) {
  const TemporaryFolder folder;
  std::ofstream(folder / "scene.yaml") << terrain << "wind: {speed: -1}\nseed: x\n";
  const FinishedProcess result = understory_command({"validate", folder / "scene.yaml"});
  EXPECT_THAT(result.err, HasSubstr("speed"));
  EXPECT_THAT(result.err, HasSubstr("seed"));
}

TEST(BadInput, JudgesOverridesLikeTheFile) {
  const TemporaryFolder folder;
  const FinishedProcess result = understory_command(
      {"run", scenes_folder + "/tiny.yaml", "-o", folder / "out", "--set", "wind.speed=-3", "--quiet"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, IsOneMessageWith("wind.speed"));
}

TEST(BadInput, RefusesFoldersThatCannotBeWritten) {
  for (const char* folder : {"/proc/out", "/dev/null/out"}) {
    const FinishedProcess result = understory_command({"run", scenes_folder + "/tiny.yaml", "-o", folder});
    EXPECT_EQ(result.exit_code, 5) << result.err;
    EXPECT_THAT(result.err, IsOneMessageWith(folder));
  }
}

TEST(BadInput, LeavesOtherPeoplesFilesAlone) {
  const TemporaryFolder folder;
  std::ofstream(folder / "thesis.tex") << "precious";
  const FinishedProcess result = understory_command({"run", scenes_folder + "/tiny.yaml", "-o", folder.path()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, IsOneMessageWith("--force"));
  EXPECT_EQ(file_text(folder / "thesis.tex"), "precious");
}

}  // namespace
}  // namespace understory
