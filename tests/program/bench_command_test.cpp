// `understory bench`: right results beside roofs of the same run, for people and machines. Never how fast.
#include <algorithm>
#include <set>

#include "tests/program/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace understory {
namespace {

using testing::HasSubstr;

FinishedProcess small_bench(std::vector<std::string> more) {
  std::vector<std::string> arguments = {"bench", "--fragments", "5003", "--repetitions", "3", "--frames", "2"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return understory_command(arguments);
}

TEST(Bench, ReportsVerifiedKernelsAndFramesForMachines) {
  const FinishedProcess bench = small_bench({"--json", scenes_folder + "/tiny.yaml"});
  ASSERT_EQ(bench.exit_code, 0) << bench.err;
  const auto report = nlohmann::json::parse(bench.out);
  EXPECT_TRUE(report.contains("device"));
  for (const auto& [name, value] : report.at("roofs").items()) EXPECT_GT(value.get<double>(), 0) << name;
  std::set<std::string> names;
  for (const auto& result : report.at("results")) {
    for (const char* key : {"median_ms", "low_ms", "high_ms", "items_per_s", "bytes_per_s", "roof_share", "bound_by"})
      EXPECT_TRUE(result.contains(key)) << result.at("name") << " " << key;
    EXPECT_TRUE(result.at("verified").get<bool>()) << result.at("name");
    EXPECT_LE(result.at("low_ms").get<double>(), result.at("median_ms").get<double>()) << result.at("name");
    EXPECT_LE(result.at("median_ms").get<double>(), result.at("high_ms").get<double>()) << result.at("name");
    names.insert(result.at("name").get<std::string>());
  }
  for (const char* kernel : {"kernel/sphere-cap", "kernel/grass-height", "kernel/solid-angle-cosine", "kernel/combine"})
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
