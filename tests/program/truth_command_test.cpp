// `understory truth` and `understory compare` as a user types them.
#include "tests/program/program.hpp"
#include "tests/support/temporary_folder.hpp"
#include "viz/exr/frame_exr.hpp"

namespace understory {
namespace {

const std::string scene = scenes_folder + "/tiny.yaml";

TEST(TruthCommand, WritesTheFrameWithItsUncertainty) {
  const TemporaryFolder folder;
  const std::string first = folder / "a.exr", second = folder / "b.exr";
  const auto result = understory_command({"truth", scene, "-o", first, "--frame", "1", "--rays", "32", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto told = nlohmann::json::parse(result.out);
  EXPECT_EQ(told.at("rays"), 32);
  EXPECT_GT(told.at("rays_per_s"), 0);
  const auto run =
      understory_command({"run", scene, "-o", folder / "out", "--frames", "1", "--dump", "exr", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Frame truth = read_frame_exr(first), method = read_frame_exr(folder / "out/frame_0001.exr");
  EXPECT_EQ(truth.owner, method.owner);
  EXPECT_EQ(truth.position, method.position);
  EXPECT_EQ(truth.normal, method.normal);
  EXPECT_EQ(truth.height_above_root, method.height_above_root);
  for (std::size_t i = 0; i < truth.pixels(); ++i) {
    const bool background = (truth.validity[i] & validity::background) != 0;
    ASSERT_EQ(truth.rays[i], background ? 0u : 32u);
    ASSERT_EQ(truth.halfwidth[i] > 0, !background);
    ASSERT_TRUE(truth.visibility[i] >= 0 && truth.visibility[i] <= 1);
  }
  ASSERT_EQ(
      understory_command({"truth", scene, "-o", second, "--frame", "1", "--rays", "32", "--threads", "1"}).exit_code,
      0);
  EXPECT_EQ(file_text(first), file_text(second)) << "the same bytes on any number of threads";
}

TEST(TruthCommand, TracesAForeignGbufferAlike) {
  const TemporaryFolder folder;
  ASSERT_EQ(understory_command({"run", scene, "-o", folder / "out", "--frames", "0", "--dump", "exr,ply", "--quiet"})
                .exit_code,
            0);
  const std::string gbuffer = folder / "out/frame_0000.exr", mesh = folder / "out/frame_0000.ply";
  const auto external =
      understory_command({"truth", gbuffer, "--mesh", mesh, "-o", folder / "external.exr", "--rays", "64"});
  ASSERT_EQ(external.exit_code, 0) << external.err;
  ASSERT_EQ(understory_command({"truth", scene, "-o", folder / "truth.exr", "--rays", "64"}).exit_code, 0);
  const auto compared =
      understory_command({"compare", folder / "external.exr", folder / "truth.exr", "--json", "--max-rmse", "0.005"});
  EXPECT_EQ(compared.exit_code, 0) << compared.out << compared.err;
  const auto far = understory_command(
      {"truth", gbuffer, "--mesh", mesh, "-o", folder / "near.exr", "--rays", "64", "--max-distance", "0.001"});
  ASSERT_EQ(far.exit_code, 0) << far.err;
  const Frame near = read_frame_exr(folder / "near.exr");
  for (std::size_t i = 0; i < near.pixels(); ++i) ASSERT_GT(near.visibility[i], 0.4) << "hardly anything is so near";
}

TEST(TruthCommand, RefusesWhatItCannotTrace) {
  const TemporaryFolder folder;
  const std::string out = folder / "x.exr";
  const std::vector<std::vector<std::string>> wrong = {{"truth", scene},
                                                       {"truth", scene, "-o", out, "--rays", "8"},
                                                       {"truth", scene, "-o", out, "--max-distance", "0"},
                                                       {"truth", scene, "-o", out, "--weighting", "square"},
                                                       {"truth", scene, "-o", out, "--mesh", "x.ply"}};
  for (const auto& arguments : wrong)
    EXPECT_EQ(understory_command(arguments).exit_code, 2) << testing::PrintToString(arguments);
  EXPECT_FALSE(std::filesystem::exists(out));
}

class Compare : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(understory_command({"run", scene, "-o", folder / "out", "--frames", "0:2", "--dump", "exr", "--quiet"})
                  .exit_code,
              0);
    ASSERT_EQ(understory_command({"truth", scene, "-o", truth, "--rays", "64", "--quiet"}).exit_code, 0);
  }
  const TemporaryFolder folder;
  const std::string frame = folder / "out/frame_0000.exr", truth = folder / "truth.exr";
};

TEST_F(Compare, TellsTheKeysThatScriptsRelyOn) {
  const auto result = understory_command({"compare", frame, truth, "--json", "--difference", folder / "d.exr"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  for (const char* key :
       {"rmse", "rmse_denoised", "mae", "bias", "max", "p95", "ssim", "log_mae", "pixels", "inside_interval"})
    EXPECT_TRUE(json.at(key).is_number()) << key;
  EXPECT_GT(json.at("rmse"), 0.01);
  std::size_t pixels = 0;
  for (const auto& [name, errors] : json.at("classes").items()) pixels += errors.at("pixels").get<std::size_t>();
  EXPECT_EQ(pixels, json.at("pixels"));
  EXPECT_TRUE(json.at("classes").contains("blade"));
  EXPECT_TRUE(std::filesystem::exists(folder / "d.exr"));
  EXPECT_EQ(understory_command({"compare", frame, truth, "--difference", folder / "d.png"}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "d.png"));
}

TEST_F(Compare, OfAFrameWithItselfIsZero) {
  const auto result = understory_command({"compare", frame, frame, "--json", "--max-rmse", "0"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json.at("rmse"), 0);
  EXPECT_NEAR(json.at("ssim"), 1, 1e-6);
}

TEST_F(Compare, ExitsWith7OverItsThreshold) {
  const auto result = understory_command({"compare", frame, truth, "--max-rmse", "0.001"});
  EXPECT_EQ(result.exit_code, 7);
  EXPECT_THAT(result.err, IsOneMessageWith("--max-rmse"));
  EXPECT_THAT(result.out, testing::HasSubstr("blade"));
}

TEST_F(Compare, TakesOneTermAgainstTheTruth) {
  const auto result = understory_command({"compare", frame, truth, "--channel", "open-dome", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_GT(nlohmann::json::parse(result.out).at("bias"), 0) << "the dome alone is brighter than the truth";
  const auto unknown = understory_command({"compare", frame, truth, "--channel", "moonlight"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, IsOneMessageWith("open-dome"));
}

TEST_F(Compare, RefusesFramesOfDifferentThings) {
  ASSERT_EQ(
      understory_command({"truth", scene, "-o", folder / "small.exr", "--rays", "16", "--size", "50x40"}).exit_code, 0);
  const auto size = understory_command({"compare", frame, folder / "small.exr"});
  EXPECT_EQ(size.exit_code, 3);
  EXPECT_THAT(size.err, IsOneMessageWith("50 x 40"));
  const auto moved = understory_command(
      {"truth", scene, "-o", folder / "moved.exr", "--rays", "16", "--set", "camera.position=[0, -3, 1]"});
  ASSERT_EQ(moved.exit_code, 0) << moved.err;
  const auto other = understory_command({"compare", frame, folder / "moved.exr"});
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_THAT(other.err, IsOneMessageWith("show different things"));
  EXPECT_EQ(understory_command({"compare", frame, folder / "none.exr"}).exit_code, 3);
}

}  // namespace
}  // namespace understory
