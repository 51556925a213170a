// Frames do not depend on how many threads compute them: whole runs in child processes, because PoCL and TBB fix their
// threads when a process first uses them.
#include "tests/program/program.hpp"

namespace understory {
namespace {

/// EXR files of two frames of the tiny scene with enough grass and pixels that every launch has many work-groups.
std::vector<std::string> frames_on(const std::string& threads, const TemporaryFolder& folder) {
  const FinishedProcess result =
      understory_command({"run", scenes_folder + "/tiny.yaml", "-o", folder / threads, "--frames", "0:2", "--size",
                          "211x137", "--dump", "exr,ply", "--set", "grass.0.density=300", "--quiet"},
                         {"POCL_MAX_PTHREAD_COUNT=" + threads});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  std::vector<std::string> files;
  for (const char* name : {"frame_0000.exr", "frame_0001.exr", "frame_0000.ply", "frame_0001.ply"})
    files.push_back(file_text((folder / threads) / name));
  return files;
}

TEST(Threads, OfAnyNumberGiveTheSameBytes) {
  const TemporaryFolder folder;
  const std::vector<std::string> alone = frames_on("1", folder);
  for (const std::string& file : alone) ASSERT_GT(file.size(), 10000u);
  EXPECT_NE(alone[0], alone[1]) << "nothing moves";
  for (const char* threads : {"2", "3", "7"}) {
    const std::vector<std::string> many = frames_on(threads, folder);
    for (std::size_t i = 0; i < alone.size(); ++i) EXPECT_TRUE(many[i] == alone[i]) << threads << " threads, " << i;
  }
}

}  // namespace
}  // namespace understory
