// `run --max-error` and `--max-ms`: the methods are chosen, promised and checked; a run that does not adapt is the run
// that names the same methods; a budget that nothing keeps is refused.
#include <fstream>

#include "tests/program/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Eight frames: four to choose by, three to check on.
FinishedProcess run_tiny(const fs::path& out, std::vector<std::string> more) {
  std::vector<std::string> arguments = {
      "run", scenes_folder + "/tiny.yaml", "-o", out, "--set", "time.frames=8", "--frames", "0:3", "--dump", "exr"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return understory_command(arguments);
}

nlohmann::json record_in(const fs::path& out) { return nlohmann::json::parse(file_text(out / "run.json")); }

std::vector<std::string> hashes_of(const nlohmann::json& record) {
  std::vector<std::string> hashes;
  for (const auto& frame : record.at("frames")) hashes.push_back(frame.at("sha256"));
  return hashes;
}

TEST(RunBudget, PromisesAnErrorAndChecksItOnOtherFrames) {
  const TemporaryFolder folder;
  const FinishedProcess result = run_tiny(folder / "out", {"--max-error", "0.3", "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("promised "));
  EXPECT_THAT(result.out, HasSubstr("found "));
  const auto record = record_in(folder / "out");
  const auto& budget = record.at("budget");
  EXPECT_EQ(budget.at("max_error"), 0.3);
  EXPECT_LE(budget.at("promised_rmse"), 0.3);
  EXPECT_LE(budget.at("found_rmse"), 0.3);
  EXPECT_GT(budget.at("found_rmse"), 0);
  EXPECT_EQ(budget.at("checked_on").size(), 3u);
  for (const auto& frame : budget.at("checked_on"))
    EXPECT_THAT(budget.at("chosen_by"), testing::Not(testing::Contains(frame)));
  EXPECT_FALSE(record.at("adaptive").get<bool>());
  for (const auto& frame : record.at("frames")) EXPECT_FALSE(frame.contains("chosen"));

  // What was measured is kept, and the same comes out again.
  const FinishedProcess again = run_tiny(folder / "again", {"--max-error", "0.3"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.err, testing::Not(HasSubstr("measuring")));
  EXPECT_EQ(hashes_of(record_in(folder / "again")), hashes_of(record));

  // The same methods by name: the same bytes.
  std::vector<std::string> named = {"--quiet"};
  for (const auto& [key, method] : record.at("methods").items())
    named.insert(named.end(), {"--" + key, method.get<std::string>()});
  const FinishedProcess plain = run_tiny(folder / "plain", named);
  ASSERT_EQ(plain.exit_code, 0) << plain.err;
  EXPECT_EQ(hashes_of(record_in(folder / "plain")), hashes_of(record));
}

TEST(RunBudget, MarksAnAdaptiveRun) {
  const TemporaryFolder folder;
  const FinishedProcess result = run_tiny(folder / "out", {"--max-ms", "10000", "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("adaptive"));
  const auto record = record_in(folder / "out");
  EXPECT_TRUE(record.at("adaptive").get<bool>());
  EXPECT_LE(record.at("budget").at("promised_ms"), 10000);
  for (const auto& frame : record.at("frames"))
    EXPECT_EQ(frame.at("chosen"), record.at("budget").at("choice")) << "time enough for the most accurate";
  EXPECT_THAT(file_text(folder / "out/frame_0000.exr"), HasSubstr("understory:adaptive"));
}

TEST(RunBudget, RefusesWhatNothingKeeps) {
  const TemporaryFolder folder;
  const FinishedProcess error = run_tiny(folder / "out", {"--max-error", "1e-6", "--quiet"});
  EXPECT_EQ(error.exit_code, 7);
  EXPECT_THAT(error.err, HasSubstr("understory: error: --max-error 1e-06: no methods keep it in this scene"));
  const FinishedProcess time = run_tiny(folder / "out", {"--max-ms", "1e-6", "--quiet"});
  EXPECT_EQ(time.exit_code, 7);
  EXPECT_THAT(time.err, HasSubstr("understory: error: --max-ms 1e-06: no methods keep it in this scene"));
  EXPECT_FALSE(fs::exists(folder / "out")) << "nothing was run";
}

TEST(RunBudget, RefusesTwoBudgetsAndMethodsBesideOne) {
  const TemporaryFolder folder;
  EXPECT_EQ(run_tiny(folder / "out", {"--max-ms", "9", "--max-error", "0.1"}).exit_code, 2);
  EXPECT_EQ(run_tiny(folder / "out", {"--max-error", "0.1", "--tree", "ambient"}).exit_code, 2);
  EXPECT_EQ(run_tiny(folder / "out", {"--max-error", "-1"}).exit_code, 2);
  EXPECT_EQ(run_tiny(folder / "out", {"--max-error", "1.5"}).exit_code, 2);
}

TEST(RunBudget, LooksAtTheFolderBeforeItMeasures) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "out");
  std::ofstream(folder / "out/mine.txt") << "mine";
  const FinishedProcess result = run_tiny(folder / "out", {"--max-error", "0.3"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("not empty"));
  EXPECT_THAT(result.err, testing::Not(HasSubstr("measuring")));
}

}  // namespace
}  // namespace understory
