// `run` as a user types it: what lies in the folder, and that the same bytes come out whatever happened on the way.
#include <csignal>
#include <map>
#include <random>
#include <set>

#include "tests/program/program.hpp"
#include "viz/exr/frame_exr.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string scene = scenes_folder + "/tiny.yaml";

/// Contents of all files by name. run.json is left out: it holds measured times.
std::map<std::string, std::string> files_in(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().filename() != "run.json") files[entry.path().filename()] = file_text(entry.path());
  return files;
}

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& [name, text] : files_in(folder)) names.insert(name);
  return names;
}

/// Names of files that differ or are in one folder only: short enough to print.
std::vector<std::string> differing(const fs::path& a, const fs::path& b) {
  const auto left = files_in(a), right = files_in(b);
  std::vector<std::string> names;
  for (const auto& [name, text] : left)
    if (!right.contains(name) || right.at(name) != text) names.push_back(name);
  for (const auto& [name, text] : right)
    if (!left.contains(name)) names.push_back(name);
  return names;
}

nlohmann::json record_in(const fs::path& folder) { return nlohmann::json::parse(file_text(folder / "run.json")); }

/// run.json without what is measured.
nlohmann::json settled_record(const fs::path& folder) {
  nlohmann::json record = record_in(folder);
  record.erase("peak_rss_mib");
  for (const char* key : {"memory_mib", "max_allocation_mib", "compute_units"}) record["device"].erase(key);
  for (auto& frame : record["frames"]) frame.erase("ms"), frame.erase("passes");
  return record;
}

FinishedProcess run_scene(const fs::path& out, const std::vector<std::string>& more = {},
                          const std::vector<std::string>& environment = {}) {
  std::vector<std::string> arguments = {"run", scene, "-o", out, "--quiet"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return understory_command(arguments, environment);
}

TEST(Run, LeavesFramesPicturesAndARecord) {
  const TemporaryFolder folder;
  const fs::path out = folder / "a folder with spaces";
  const FinishedProcess result = run_scene(out, {"--dump", "exr,png,vtk,ply"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  for (const char* name :
       {"frame_0000.exr", "frame_0002.png", "visibility_0001.png", "frame_0000.vti", "frame_0000.vtp", "frame_0000.ply",
        "planes.pvd", "geometry.pvd", "contact_sheet.png", "movie.ogv"})
    EXPECT_TRUE(fs::exists(out / name)) << name;
  EXPECT_THAT(result.out, HasSubstr("median ms"));
  const nlohmann::json record = record_in(out);
  for (const char* key : {"device", "seed", "plan", "programs", "peak_rss_mib", "frames", "validity"})
    EXPECT_TRUE(record.contains(key)) << key;
  ASSERT_EQ(record.at("frames").size(), 3u);
  for (const auto& frame : record.at("frames")) {
    EXPECT_GT(frame.at("ms"), 0);
    for (const auto& pass : record.at("plan")) EXPECT_TRUE(frame.at("passes").contains(pass)) << pass;
  }
  EXPECT_NEAR(record.at("frames")[2].at("time_s").get<double>(), 2 / 12.0, 1e-12);
}

TEST(Run, CountsWhatLiesInsideASolidAndWritesItAsAChannel) {
  const TemporaryFolder folder;
  std::ofstream(folder / "boxes.yaml") << R"(
name: a box in a box, and the camera with it
time: {fps: 24, frames: 1}
image: {width: 60, height: 40}
camera: {position: [0.45, 0.1, 0.6], target: [0, 0, 0.5], fov: 60, near: 0.01}
terrain: {flat: {extent: {low: [-3, -3], high: [3, 3]}}}
occluders:
  - {name: outer, parts: [{box: [1, 1, 1]}], keyframes: [{time: 0, position: [0, 0, 0.5]}]}
  - {name: inner, parts: [{box: [0.2, 0.2, 0.2]}], keyframes: [{time: 0, position: [0, 0, 0.5]}]}
methods: {occluders: grid-cone, grid: {rays: 32}}
)";
  const FinishedProcess run = understory_command(
      {"run", folder / "boxes.yaml", "-o", folder / "out", "--frames", "0", "--dump", "exr", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Frame frame = read_frame_exr(folder / "out/frame_0000.exr");
  std::uint64_t inside = 0;
  for (std::size_t i = 0; i < frame.pixels(); ++i) {
    const bool on_inner = frame.owners.at(frame.owner[i]).species.starts_with("inner");
    EXPECT_EQ((frame.validity[i] & validity::occluder_too_close) != 0, on_inner) << i;
    inside += on_inner;
  }
  EXPECT_GT(inside, 100u);
  EXPECT_EQ(record_in(folder / "out").at("validity").at("16"), inside);
}

TEST(Run, GivesTheSameBytesTwiceAloneInAnyOrderOnAnyNumberOfThreads) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_scene(folder / "first").exit_code, 0);
  ASSERT_EQ(run_scene(folder / "second", {"--threads", "1"}).exit_code, 0);
  EXPECT_THAT(differing(folder / "first", folder / "second"), testing::IsEmpty());
  for (int frame : {2, 0, 1}) {  // one at a time, out of order
    const auto result = run_scene(folder / "third", {"--resume", "--frames", std::to_string(frame)});
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  EXPECT_THAT(differing(folder / "first", folder / "third"), testing::IsEmpty());
  EXPECT_EQ(settled_record(folder / "first"), settled_record(folder / "third"));
}

TEST(Run, EndsWithTheSameBytesAfterBeingKilledAnywhere) {
  const TemporaryFolder folder;
  const std::vector<std::string> frames = {"--frames", "0:12"};
  ASSERT_EQ(run_scene(folder / "whole", frames).exit_code, 0);
  std::mt19937 random(2026);
  std::uniform_int_distribution<int> frames_before_kill(0, 2), more_microseconds(0, 60'000);
  const fs::path out = folder / "killed";
  int kills = 0, exit_code = -1;
  while (exit_code != 0 && kills < 40) {
    const auto done = [&] {
      std::size_t count = 0;
      if (fs::exists(out))
        for (const auto& entry : fs::directory_iterator(out)) count += entry.path().extension() == ".exr";
      return count;
    };
    const std::size_t target = done() + static_cast<std::size_t>(frames_before_kill(random));
    Process run({program_path, "run", scene, "-o", out, "--quiet", "--resume", "--frames", "0:12"});
    run.wait_until([&] { return done() > target; });
    std::this_thread::sleep_for(std::chrono::microseconds(more_microseconds(random)));
    run.send(SIGKILL);
    exit_code = run.wait().exit_code;
    if (exit_code != 0) ++kills;
  }
  EXPECT_GE(kills, 2) << "the run was too quick to be killed";
  ASSERT_EQ(run_scene(out, {"--resume", "--frames", "0:12"}).exit_code, 0);
  EXPECT_THAT(differing(folder / "whole", out), testing::IsEmpty());
  EXPECT_EQ(settled_record(folder / "whole"), settled_record(out));
}

TEST(Run, RepairsADamagedFrame) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_scene(folder / "whole").exit_code, 0);
  ASSERT_EQ(run_scene(folder / "out").exit_code, 0);
  fs::resize_file(folder.path() / "out" / "frame_0001.exr", 100);
  fs::remove(folder.path() / "out" / "visibility_0002.png");
  ASSERT_EQ(run_scene(folder / "out", {"--resume"}).exit_code, 0);
  EXPECT_THAT(differing(folder / "whole", folder / "out"), testing::IsEmpty());
}

TEST(Run, FinishesTheFrameAtHandWhenAskedToStop) {
  for (const auto& [signal, code] : {std::pair{SIGINT, 130}, std::pair{SIGTERM, 143}}) {
    const TemporaryFolder folder;
    const fs::path out = folder / "out";
    Process run({program_path, "run", scene, "-o", out, "--frames", "0:5000"});
    ASSERT_TRUE(run.wait_until([&] { return fs::exists(out / "visibility_0001.png"); })) << run.err();
    run.send(signal);
    const FinishedProcess result = run.wait();
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_THAT(result.err, HasSubstr("--resume"));
    const nlohmann::json record = record_in(out);
    EXPECT_EQ(record.at("complete"), false);
    EXPECT_GE(record.at("frames").size(), 2u);
    for (const std::string& name : names_in(out)) EXPECT_NE(name.front(), '.') << name << " is a temporary file";
    for (const auto& frame : record.at("frames"))
      for (const auto& [name, sha256] : frame.at("files").items()) EXPECT_TRUE(fs::exists(out / name)) << name;
  }
}

TEST(Run, RefusesToMixTwoRuns) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_scene(folder / "out", {"--frames", "0"}).exit_code, 0);
  const auto again = run_scene(folder / "out");
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.err, IsOneMessageWith("--resume"));
  const auto other = run_scene(folder / "out", {"--resume", "--set", "wind.speed=9"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, IsOneMessageWith("scene"));
  EXPECT_EQ(run_scene(folder / "out", {"--force", "--set", "wind.speed=9", "--frames", "1"}).exit_code, 0);
  EXPECT_FALSE(fs::exists(folder.path() / "out" / "frame_0000.exr")) << "--force replaces the run";
}

TEST(Run, KeepsFinishedFramesWhenTheDiskIsFull) {
  const TemporaryFolder folder;
  const std::string script =
      "mount -t tmpfs -o size=600k tmpfs \"$1\" || exit 77\n"
      "\"$0\" run \"$2\" -o \"$1/out\" --quiet --frames 0:50 --dump exr; echo \"code $?\"\n"
      "ls -A \"$1/out\"";
  const FinishedProcess result =
      run_process({"unshare", ::geteuid() == 0 ? "-m" : "-rm", "sh", "-c", script, program_path, folder.path(), scene});
  // Only a machine that refuses the mount never gets as far as the program.
  if (result.out.find("code ") == std::string::npos)
    GTEST_SKIP() << "cannot mount a small file system here: " << result.err;
  EXPECT_THAT(result.out, HasSubstr("code 5\n"));
  EXPECT_THAT(result.out, HasSubstr("frame_0000.exr\n"));
  EXPECT_THAT(result.out, testing::Not(HasSubstr(".tmp"))) << "nothing unfinished stays";
  EXPECT_THAT(result.err, IsOneMessageWith("No space left on device"));
}

TEST(Run, MakesTheSamePlanesWithAndWithoutSupersampling) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_scene(folder / "one", {"--frames", "1"}).exit_code, 0);
  ASSERT_EQ(run_scene(folder / "four", {"--frames", "1", "--supersample", "2"}).exit_code, 0);
  EXPECT_EQ(file_text(folder.path() / "one" / "frame_0001.exr"), file_text(folder.path() / "four" / "frame_0001.exr"));
  EXPECT_NE(file_text(folder.path() / "one" / "frame_0001.png"), file_text(folder.path() / "four" / "frame_0001.png"));
}

TEST(Run, SurvivesADamagedKernelCache) {
  const TemporaryFolder folder, cache;
  const std::vector<std::string> environment = {"XDG_CACHE_HOME=" + cache.path().string()};
  ASSERT_EQ(run_scene(folder / "first", {"--frames", "0"}, environment).exit_code, 0);
  int damaged = 0;
  for (const auto& entry : fs::recursive_directory_iterator(cache.path()))
    if (entry.is_regular_file() && entry.path().extension() == ".so") fs::resize_file(entry.path(), 64), ++damaged;
  ASSERT_GT(damaged, 0);
  const FinishedProcess result = run_scene(folder / "second", {"--frames", "0"}, environment);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(differing(folder / "first", folder / "second"), testing::IsEmpty());
}

TEST(Run, PrintsItsRecordForMachines) {
  const TemporaryFolder folder;
  const FinishedProcess result = run_scene(folder / "out", {"--json", "--frames", "0"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(nlohmann::json::parse(result.out), record_in(folder / "out"));
}

}  // namespace
}  // namespace understory
