// `understory stability` as a user types it.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/program/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace understory {
namespace {

using testing::HasSubstr;

TEST(StabilityCommand, WritesATableForPeopleAndOneForMachines) {
  const TemporaryFolder folder;
  const std::filesystem::path output = folder / "stability";
  const FinishedProcess done =
      understory_command({"stability", "-o", output.string(), "--filter", "sphere-cap", "--samples", "100"});
  ASSERT_EQ(done.exit_code, 0) << done.err << done.out;
  EXPECT_THAT(done.out, HasSubstr(" 0 failures"));
  EXPECT_THAT(file_text(output / "stability.md"), HasSubstr("## sphere-cap"));
  const nlohmann::json json = nlohmann::json::parse(file_text(output / "stability.json"));
  EXPECT_GT(json.at("cases"), 10);
  for (const nlohmann::json& row : json.at("rows")) {
    EXPECT_EQ(row.at("kernel"), "sphere-cap");
    EXPECT_TRUE(row.at("relaxed").contains("max_abs_error"));
  }
}

TEST(StabilityCommand, NamesWhatIsWrong) {
  const TemporaryFolder folder;
  const FinishedProcess none = understory_command({"stability", "-o", (folder / "a").string(), "--filter", "no such"});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.err, IsOneMessageWith("no such"));
  EXPECT_EQ(understory_command({"stability"}).exit_code, 2);
  const FinishedProcess file = understory_command({"stability", "-o", "/dev/null/x", "--filter", "open-dome"});
  EXPECT_EQ(file.exit_code, 5);
  EXPECT_THAT(file.err, IsOneMessageWith("/dev/null/x"));
}

}  // namespace
}  // namespace understory
