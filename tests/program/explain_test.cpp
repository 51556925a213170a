// `understory explain`: what it says about the plan agrees with what a run does.
#include <set>
#include <sstream>

#include "tests/program/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace understory {
namespace {

using testing::HasSubstr;

const std::string tiny = scenes_folder + "/tiny.yaml";

FinishedProcess explain(std::vector<std::string> more, const std::string& times = "2") {
  std::vector<std::string> arguments = {"explain", tiny, "--frames", times, "--rounds", times, "--quiet"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return understory_command(arguments);
}

nlohmann::json explained(std::vector<std::string> more, const std::string& times = "2") {
  more.push_back("--json");
  const FinishedProcess result = explain(more, times);
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

/// The programs that `explain` built, of the plan or without its one term.
std::set<std::string> programs_in(const nlohmann::json& footprint) { return footprint.at("programs"); }

TEST(Explain, ASceneOfOneMethodBuildsThatMethodsProgramBeyondDrawing) {
  struct One {
    const char *option, *method;
    std::set<std::string> programs;
  };
  const One all[] = {{"--tree", "sphere-cap", {"sphere_cap"}},
                     {"--grass", "grass-height", {"grass_height"}},
                     {"--crowns", "solid-angle-cosine", {"solid_angle", "tile_spheres"}},
                     {"--occluders", "grid", {"grid", "tile_grids"}},
                     {"--near", "obscurance-line", {"obscurance_line"}}};
  std::set<std::string> drawing;  // and what light the ground under grass gets
  for (const One& one : all) {
    std::vector<std::string> arguments = {"--set", "methods.grid.size=8", "--set", "methods.grid.rays=32"};
    for (const One& other : all) {
      arguments.emplace_back(other.option);
      arguments.emplace_back(&other == &one ? one.method : "none");
    }
    const auto report = explained(arguments, "1");
    ASSERT_EQ(report.at("terms").size(), 1u) << one.method;
    const auto &planned = report.at("planned"), &without = report.at("terms")[0].at("without");
    if (drawing.empty()) drawing = programs_in(without);
    EXPECT_EQ(programs_in(without), drawing) << one.method << ": nothing but drawing is left";
    std::set<std::string> expected = drawing;
    expected.insert(one.programs.begin(), one.programs.end());
    EXPECT_EQ(programs_in(planned), expected) << one.method;
    EXPECT_EQ(planned.at("kernels").get<std::size_t>(), without.at("kernels").get<std::size_t>() + one.programs.size());
    EXPECT_GT(planned.at("peak_buffers_mib"), without.at("peak_buffers_mib")) << one.method;
    if (&one != &all[0]) continue;
    // What is in the table is what was built: the text counts what the lists name.
    const FinishedProcess text = explain(arguments, "1");
    std::istringstream lines(text.out.substr(text.out.find("  as planned")));
    std::string words;
    double start, frame, shading, mib, peak;
    std::size_t programs, kernels;
    ASSERT_TRUE(lines >> words >> words >> start >> frame >> shading >> mib >> peak >> programs >> kernels) << text.out;
    EXPECT_EQ(programs, expected.size());
    EXPECT_EQ(kernels, planned.at("kernels").get<std::size_t>());
    EXPECT_GT(start, 0);
    EXPECT_GE(peak, mib);
  }
  EXPECT_FALSE(drawing.empty());
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
