// Commands that draw nothing: help, exit codes, where output goes, what machines read.
#include "tests/program/program.hpp"

namespace understory {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST(Program, TeachesItself) {
  const FinishedProcess help = understory_command({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.err, IsEmpty());
  for (const char* command : {"run", "view", "occlude", "validate", "devices", "cache", "schema"}) {
    EXPECT_THAT(help.out, HasSubstr(command));
    const FinishedProcess command_help = understory_command({command, "--help"});
    EXPECT_EQ(command_help.exit_code, 0) << command;
    EXPECT_GT(command_help.out.size(), 200u) << command;
  }
  EXPECT_THAT(understory_command({"--version"}).out, testing::MatchesRegex("understory [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

TEST(Program, ExitsWith2ForWrongUsage) {
  const std::vector<std::vector<std::string>> wrong = {
      {},
      {"fly"},
      {"run"},
      {"run", scenes_folder + "/tiny.yaml"},
      {"run", scenes_folder + "/tiny.yaml", "-o", "x", "--frames", "5:2"},
      {"run", scenes_folder + "/tiny.yaml", "-o", "x", "--size", "wide"},
      {"run", scenes_folder + "/tiny.yaml", "-o", "x", "--dump", "jpeg"},
      {"run", scenes_folder + "/tiny.yaml", "-o", "x", "--supersample", "9"},
      {"run", scenes_folder + "/tiny.yaml", "-o", "x", "--resume", "--force"},
      {"devices", "--xml"}};
  for (const auto& arguments : wrong) {
    const FinishedProcess result = understory_command(arguments);
    EXPECT_EQ(result.exit_code, 2) << testing::PrintToString(arguments);
    EXPECT_THAT(result.out, IsEmpty());
    EXPECT_THAT(result.err, Not(IsEmpty()));
  }
  EXPECT_FALSE(std::filesystem::exists("x")) << "wrong usage writes nothing";
}

TEST(Program, ListsDevicesForMachines) {
  const FinishedProcess result = understory_command({"devices", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto devices = nlohmann::json::parse(result.out);
  ASSERT_GE(devices.size(), 1u);
  for (const char* key : {"index", "platform", "name", "type", "version", "compute_units", "memory_mib"})
    EXPECT_TRUE(devices[0].contains(key)) << key;
}

TEST(Program, SaysWhatToDoWithoutADevice) {
  const std::vector<std::string> none = {"OCL_ICD_VENDORS=/nonexistent"};
  const TemporaryFolder folder;
  const FinishedProcess list = understory_command({"devices", "--json"}, none);
  EXPECT_EQ(list.exit_code, 4);
  EXPECT_EQ(nlohmann::json::parse(list.out), nlohmann::json::array());
  const FinishedProcess run = understory_command({"run", scenes_folder + "/tiny.yaml", "-o", folder / "out"}, none);
  EXPECT_EQ(run.exit_code, 4);
  EXPECT_THAT(run.err, IsOneMessageWith("pocl-opencl-icd"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out")) << "the same command must work once there is a device";
}

TEST(Program, NamesTheDevicesWhenTheOneAskedForIsMissing) {
  const TemporaryFolder folder;
  const FinishedProcess run =
      understory_command({"run", scenes_folder + "/tiny.yaml", "-o", folder / "out", "--device", "abacus"});
  EXPECT_EQ(run.exit_code, 4);
  EXPECT_THAT(run.err, testing::AllOf(HasSubstr("abacus"), HasSubstr("cpu")));
}

TEST(Program, TellsAndEmptiesTheKernelCache) {
  const TemporaryFolder cache;
  const std::vector<std::string> environment = {"XDG_CACHE_HOME=" + cache.path().string(), "POCL_CACHE_DIR="};
  const auto info = [&] {
    const FinishedProcess result = understory_command({"cache", "info", "--json"}, environment);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out);
  };
  EXPECT_EQ(info().at("programs"), 0);
  const FinishedProcess cleared = understory_command({"cache", "clear"}, environment);
  EXPECT_EQ(cleared.exit_code, 0) << cleared.err;
  EXPECT_THAT(cleared.out, HasSubstr(cache.path().string()));
}

TEST(Program, PrintsTheKeysOfScenes) {
  EXPECT_THAT(understory_command({"schema"}).out, HasSubstr("wind"));
  const auto schema = nlohmann::json::parse(understory_command({"schema", "--json"}).out);
  EXPECT_TRUE(schema.at("properties").contains("wind"));
}

TEST(Program, NoticesThatItsResultsCannotBeWritten) {
  const FinishedProcess result = run_process({"sh", "-c", "exec \"$0\" schema >/dev/full", program_path});
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_THAT(result.err, IsOneMessageWith("No space left on device"));
}

}  // namespace
}  // namespace understory
