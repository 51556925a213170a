// `understory bench`: right results beside roofs of the same run, for people and machines. Never how fast.
#include <algorithm>
#include <set>

#include "tests/program/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace understory {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

FinishedProcess small_bench(std::vector<std::string> more) {
  std::vector<std::string> arguments = {"bench", "--fragments", "5003", "--repetitions",
                                        "3",     "--frames",    "2",    "--skip-builds"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return understory_command(arguments);
}

TEST(Bench, ReportsVerifiedKernelsAndFramesForMachines) {
  // Kernels and frames only: peers and bakes take seconds each.
  const FinishedProcess kernels = small_bench({"--json", "--filter", "kernel/s"});
  ASSERT_EQ(kernels.exit_code, 0) << kernels.err;
  const FinishedProcess frames = small_bench({"--json", "--filter", "frame/", scenes_folder + "/tiny.yaml"});
  ASSERT_EQ(frames.exit_code, 0) << frames.err;
  auto report = nlohmann::json::parse(kernels.out);
  EXPECT_TRUE(report.contains("device"));
  EXPECT_FALSE(report.at("energy").get<std::string>().empty());
  for (const auto& [name, value] : report.at("roofs").items()) EXPECT_GT(value.get<double>(), 0) << name;
  const auto of_frames = nlohmann::json::parse(frames.out);
  for (const auto& result : of_frames.at("results")) report.at("results").push_back(result);
  std::set<std::string> names;
  for (const auto& result : report.at("results")) {
    for (const char* key : {"median_ms", "low_ms", "high_ms", "items_per_s", "bytes_per_s", "roof_share", "bound_by"})
      EXPECT_TRUE(result.contains(key)) << result.at("name") << " " << key;
    EXPECT_TRUE(result.at("verified").get<bool>()) << result.at("name");
    EXPECT_LE(result.at("low_ms").get<double>(), result.at("median_ms").get<double>()) << result.at("name");
    EXPECT_LE(result.at("median_ms").get<double>(), result.at("high_ms").get<double>()) << result.at("name");
    names.insert(result.at("name").get<std::string>());
  }
  for (const char* kernel :
       {"kernel/sphere-cap", "kernel/solid-angle-cosine", "kernel/solid-angle-cosine/list_tile_spheres"})
    EXPECT_TRUE(names.contains(kernel)) << kernel;
  EXPECT_TRUE(
      std::any_of(names.begin(), names.end(), [](const std::string& name) { return name.starts_with("frame/"); }));
}

TEST(Bench, ComparesWithAnEarlierReport) {
  const TemporaryFolder folder;
  const FinishedProcess first = small_bench({"--filter", "kernel/open-dome", "--json"});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  std::ofstream(folder / "then.json") << first.out;
  const FinishedProcess second = small_bench({"--filter", "kernel/open-dome", "--compare", folder / "then.json"});
  EXPECT_EQ(second.exit_code, 0) << second.err;
  EXPECT_THAT(second.out, HasSubstr("kernel/open-dome"));
  EXPECT_THAT(second.out, ContainsRegex("[01] faster, [01] slower, [01] same, [01] undecided"));
}

TEST(Bench, WritesCommaSeparatedValues) {
  const FinishedProcess bench = small_bench({"--filter", "kernel/open-dome", "--csv"});
  ASSERT_EQ(bench.exit_code, 0) << bench.err;
  std::istringstream lines(bench.out);
  std::string header, row, more;
  ASSERT_TRUE(std::getline(lines, header) && std::getline(lines, row));
  EXPECT_FALSE(std::getline(lines, more)) << more;
  EXPECT_THAT(header, testing::StartsWith("device,name,item,items,median_ms,"));
  EXPECT_THAT(row, HasSubstr(",kernel/open-dome,fragment,"));
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(row.begin(), row.end(), ','));
}

TEST(Bench, TellsColdAndWarmBuilds) {
  const FinishedProcess bench = understory_command(
      {"bench", "--filter", "kernel/open-dome", "--fragments", "4096", "--repetitions", "2", "--json"});
  ASSERT_EQ(bench.exit_code, 0) << bench.err;
  const auto result = nlohmann::json::parse(bench.out).at("results").at(0);
  for (const char* cache : {"cold", "warm"})
    for (const char* key : {"build_ms", "first_launch_ms"})
      EXPECT_GT(result.at(cache).at(key).get<double>(), 0) << cache;
}

TEST(Bench, DrawsTheRoofline) {
  const TemporaryFolder folder;
  const FinishedProcess bench =
      small_bench({"--filter", "kernel/open-dome", "--roofline", (folder / "roof.svg").string()});
  ASSERT_EQ(bench.exit_code, 0) << bench.err;
  const std::string svg = file_text(folder / "roof.svg");
  EXPECT_THAT(svg, HasSubstr("1  kernel/open-dome: "));
  EXPECT_THAT(svg, HasSubstr("multiply-add "));
  EXPECT_THAT(svg, testing::Not(HasSubstr("nan")));
  const FinishedProcess refused = small_bench({"--filter", "kernel/open-dome", "--roofline", "roof.jpg"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("--roofline roof.jpg: allowed are names that end in .png or .svg"));
}

TEST(Bench, SetsDevicesSideBySide) {
  const FinishedProcess bench =
      small_bench({"--filter", "kernel/open-dome", "--device", "cpu", "--device", "0", "--json"});
  ASSERT_EQ(bench.exit_code, 0) << bench.err;
  const auto report = nlohmann::json::parse(bench.out);
  ASSERT_EQ(report.at("others").size(), 1u);
  EXPECT_EQ(report.at("others").at(0).at("results").at(0).at("name"), "kernel/open-dome");
}

/// Another shape of launch, saved as --tune would, changes nothing but time.
TEST(Bench, TunesWithoutChangingResults) {
  const TemporaryFolder folder;
  const std::string file = (folder / "tuning.txt").string();
  const FinishedProcess tuned = understory_command(
      {"bench", "--tune", "--filter", "kernel/open-dome", "--fragments", "4096"}, {"UNDERSTORY_TUNING=" + file});
  ASSERT_EQ(tuned.exit_code, 0) << tuned.err;
  EXPECT_THAT(tuned.out, HasSubstr("open-dome"));
  EXPECT_THAT(file_text(file), HasSubstr("# How passes are launched on"));

  std::ofstream(file, std::ios::app) << "sphere-cap 4 64\nsolid-angle-cosine 8 512\ncombine 1 4096\ngrass-height 4 0\n";
  const auto run = [&](const std::string& name, const std::string& tuning) {
    const FinishedProcess frames =
        understory_command({"run", scenes_folder + "/tiny.yaml", "-o", (folder / name).string(), "--frames", "0:1",
                            "--dump", "exr", "--quiet"},
                           {"UNDERSTORY_TUNING=" + tuning});
    EXPECT_EQ(frames.exit_code, 0) << frames.err;
    return file_text(folder / name / "frame_0000.exr");
  };
  EXPECT_TRUE(run("tuned", file) == run("built-in", "none"));
}

TEST(Bench, RefusesATuningTableThatIsNone) {
  const TemporaryFolder folder;
  const std::string file = (folder / "tuning.txt").string();
  std::ofstream(file) << "# fine\nsphere-cap 16 256 # fine\ncombine 5 256\n";
  const FinishedProcess bench =
      understory_command({"bench", "--filter", "kernel/open-dome"}, {"UNDERSTORY_TUNING=" + file});
  EXPECT_EQ(bench.exit_code, 3);
  EXPECT_THAT(bench.err, IsOneMessageWith("tuning.txt:3: 'combine 5 256'; allowed: "));
}

TEST(Bench, RefusesAFilterThatMatchesNothing) {
  const FinishedProcess bench = small_bench({"--filter", "kernel/no-such", scenes_folder + "/tiny.yaml"});
  EXPECT_EQ(bench.exit_code, 2);
  EXPECT_THAT(bench.out, testing::IsEmpty());
  EXPECT_THAT(bench.err, HasSubstr("understory: error: --filter kernel/no-such: no benchmark has this in its name"));
}

TEST(Bench, RefusesAReportThatIsNone) {
  const TemporaryFolder folder;
  std::ofstream(folder / "then.json") << "{\"results\": 3}";
  const FinishedProcess bench = small_bench({"--filter", "kernel/open-dome", "--compare", folder / "then.json"});
  EXPECT_EQ(bench.exit_code, 3);
  EXPECT_THAT(bench.err, HasSubstr("then.json"));
}

}  // namespace
}  // namespace understory
