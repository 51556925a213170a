// `understory explain`: what it says about the plan agrees with what a run does.
#include <set>

#include "tests/program/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace understory {
namespace {

using testing::HasSubstr;

const std::string tiny = scenes_folder + "/tiny.yaml";

FinishedProcess explain(std::vector<std::string> more) {
  std::vector<std::string> arguments = {"explain", tiny, "--frames", "2", "--rounds", "2", "--quiet"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return understory_command(arguments);
}

nlohmann::json explained(std::vector<std::string> more) {
  more.push_back("--json");
  const FinishedProcess result = explain(more);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return nlohmann::json::parse(result.out);
}

std::set<std::string> values_of(const nlohmann::json& list, const char* key) {
  std::set<std::string> values;
  for (const auto& entry : list) values.insert(entry.at(key).get<std::string>());
  return values;
}

TEST(Explain, NamesThePassesAndProgramsOfARun) {
  const TemporaryFolder folder;
  const FinishedProcess run =
      understory_command({"run", tiny, "-o", folder / "out", "--frames", "0", "--dump", "exr", "--quiet", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto record = nlohmann::json::parse(run.out);
  const auto report = explained({});
  std::vector<std::string> names;
  for (const auto& pass : report.at("plan")) names.push_back(pass.at("name"));
  EXPECT_EQ(names, record.at("plan"));
  EXPECT_EQ(report.at("planned").at("programs"), record.at("programs"));
  EXPECT_GE(report.at("planned").at("kernels"), report.at("planned").at("programs").size());
  EXPECT_GT(report.at("planned").at("start_s"), 0);
  EXPECT_GT(report.at("planned").at("buffers_mib"), 0);
  EXPECT_GE(report.at("planned").at("peak_buffers_mib"), report.at("planned").at("buffers_mib"));
}

TEST(Explain, LeavesOutEachTermThatTheSceneHasAndNoOther) {
  const auto report = explained({});
  EXPECT_EQ(values_of(report.at("terms"), "key"),
            (std::set<std::string>{"methods.tree", "methods.grass", "methods.crowns", "methods.occluders"}));
  EXPECT_THAT(values_of(report.at("left_out"), "key"), testing::Contains("methods.near"));
  for (const auto& term : report.at("terms")) {
    EXPECT_GT(term.at("changed"), 0.01) << term.at("key");  // the scene was made to touch every pass
    EXPECT_FALSE(term.at("could_go").get<bool>()) << term.at("key");
    EXPECT_LE(term.at("rms"), term.at("max")) << term.at("key");
    EXPECT_LE(term.at("cost_ms").at("low"), term.at("cost_ms").at("high")) << term.at("key");
  }
}

TEST(Explain, LetsATermGoThatChangesNearlyNothing) {
  // A near field of 0.1 mm sees no other surface.
  const auto report = explained({"--near", "obscurance-line", "--set", "methods.near_field.radius=1e-4"});
  const auto& near = report.at("terms").back();
  EXPECT_EQ(near.at("key"), "methods.near");
  EXPECT_LT(near.at("changed"), 0.01);
  EXPECT_TRUE(near.at("could_go").get<bool>());
  const auto with = report.at("planned").at("programs"), without = near.at("without").at("programs");
  EXPECT_THAT(with, testing::Contains("obscurance_line"));
  EXPECT_THAT(without, testing::Not(testing::Contains("obscurance_line")));
  EXPECT_LT(near.at("without").at("kernels"), report.at("planned").at("kernels"));
}

TEST(Explain, SpeaksToAPerson) {
  const FinishedProcess result = explain({"--grass", "none", "--crowns", "none"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("crowns on everything else              methods.crowns: none"));
  EXPECT_THAT(result.out, HasSubstr("changes "));
  EXPECT_THAT(result.out, HasSubstr("as planned"));
  EXPECT_THAT(result.err, testing::Not(HasSubstr("without"))) << "no progress with --quiet";
}

}  // namespace
}  // namespace understory
