// `occlude`: the passes on planes from a file give what they gave when the planes were drawn.
#include <cmath>

#include "tests/program/program.hpp"
#include "tests/support/data.hpp"
#include "viz/exr/frame_exr.hpp"

namespace understory {
namespace {

using testing::HasSubstr;

const std::string scene = scenes_folder + "/tiny.yaml";

TEST(Occlude, RepeatsWhatRunComputed) {
  const TemporaryFolder folder;
  ASSERT_EQ(understory_command({"run", scene, "-o", folder / "out", "--frames", "2", "--quiet"}).exit_code, 0);
  const std::string in = folder / "out/frame_0002.exr", out = folder / "again.exr";
  const Frame first = read_frame_exr(in);
  const auto result = understory_command({"occlude", in, "-o", out, "--scene", scene, "--json"});  // at the file's time
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_GE(nlohmann::json::parse(result.out).at("notes").size(), 2u);
  const Frame again = read_frame_exr(out);
  EXPECT_EQ(again.time, first.time);
  EXPECT_FALSE(again.terms.contains("grass-height")) << "nothing says how long the blades are";
  ASSERT_EQ(again.pixels(), first.pixels());
  for (std::size_t i = 0; i < first.pixels(); ++i) {
    if (first.owners.at(first.owner[i]).surface == SurfaceClass::blade) continue;  // the file lacks each blade's length
    ASSERT_NEAR(again.visibility[i], first.visibility[i], 2e-4) << "pixel " << i;  // positions pass through another eye
  }
}

TEST(Occlude, RefusesACameraThatSeesNothing) {
  const TemporaryFolder folder;
  ASSERT_EQ(understory_command({"run", scene, "-o", folder / "out", "--frames", "0", "--quiet"}).exit_code, 0);
  for (const std::vector<std::string>& camera :
       {std::vector<std::string>{"1", "2", "3", "1", "2", "3", "40"}, {"0", "0", "0", "1", "0", "0", "180"}}) {
    std::vector<std::string> arguments = {"occlude", folder / "out/frame_0000.exr", "-o", folder / "x.exr", "--camera"};
    arguments.insert(arguments.end(), camera.begin(), camera.end());
    const auto result = understory_command(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.out;
    EXPECT_THAT(result.err, HasSubstr("--camera"));
    EXPECT_FALSE(std::filesystem::exists(folder / "x.exr"));
  }
}

TEST(Occlude, KnowsOnlyTheDomeWithoutAScene) {
  const TemporaryFolder folder;
  ASSERT_EQ(understory_command({"run", scene, "-o", folder / "out", "--frames", "0", "--quiet"}).exit_code, 0);
  const auto result = understory_command({"occlude", folder / "out/frame_0000.exr", "-o", folder / "open.exr"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("--scene"));
  const Frame open = read_frame_exr(folder / "open.exr");
  for (std::size_t i = 0; i < open.pixels(); ++i)
    if (!(open.validity[i] & validity::background)) {
      ASSERT_NEAR(open.visibility[i], (1 + open.normal[2][i]) / 2, 1e-5) << "the open dome over a tilted plane";
    }
}

TEST(Occlude, TakesTheChannelsOfBlender) {
  UNDERSTORY_NEEDS_DATA();
  const TemporaryFolder folder;
  const auto result = understory_command(
      {"occlude", data_folder() / "gbuffer" / "gbuffer_walnut_meadow.exr", "-o", folder / "out.exr"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("Position.X"));
  EXPECT_THAT(result.out, HasSubstr("Normal.X"));
}

TEST(Occlude, RefusesWhatIsNoGbuffer) {
  const TemporaryFolder folder;
  std::ofstream(folder / "broken.exr") << "v/1\x01 and no more";
  for (const char* name : {"broken.exr", "missing.exr"}) {
    const std::string in = folder / name;
    const auto result = understory_command({"occlude", in, "-o", folder / "out.exr"});
    EXPECT_EQ(result.exit_code, 3) << result.err;
    EXPECT_THAT(result.err, IsOneMessageWith(in));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "out.exr"));
}

}  // namespace
}  // namespace understory
