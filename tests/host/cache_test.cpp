// The cache of compiled kernels: many processes at once, damage of every kind, places that cannot be written.
// Damage kills the process that meets it, so those tests run this program again as a worker.
#include "host/opencl/cache.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include "host/opencl/buffer.hpp"
#include "host/opencl/cache_entries.hpp"
#include "host/opencl/kernel.hpp"
#include "tests/support/process.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

class CacheTest : public testing::Test {
 protected:
  TemporaryFolder temporary_;
  const fs::path& root_ = temporary_.path();
};

/// This program again, for its worker test alone.
const std::vector<std::string> worker = {"/proc/self/exe", "--gtest_filter=CacheWorker.*"};

/// The environment of a worker: no word on where the cache lies but `more`.
std::vector<std::string> variables(const std::vector<std::string>& more) {
  std::vector<std::string> all = {"POCL_CACHE_DIR=", "XDG_CACHE_HOME="};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

void expect_success(const FinishedProcess& process) { EXPECT_EQ(process.exit_code, 0) << process.out << process.err; }

void run_worker(const std::vector<std::string>& more) { expect_success(run_process(worker, variables(more))); }

TEST(CacheWorker, BuildsAndRuns) {
  Device device;
  std::vector<float> values(777);
  std::iota(values.begin(), values.end(), 0.0f);
  Buffer<float> in(device, std::span<const float>(values), "in");
  const char* wanted = std::getenv("UNDERSTORY_TEST_PROGRAMS");
  const int programs = wanted ? std::atoi(wanted) : 2;
  for (int variant = 0; variant < programs; ++variant) {
    Buffer<float> out(device, values.size(), "out");
    Kernel copy(device, "roofline", "copy_plane", "copy", "-DW=1 -DVARIANT=" + std::to_string(variant));
    copy.launch(values.size(), 64, in, out, static_cast<unsigned>(values.size()));
    ASSERT_EQ(out.read(), values);
  }
}

TEST_F(CacheTest, ManyProcessesShareAColdOne) {
  const auto cold = variables({"XDG_CACHE_HOME=" + root_.string(), "UNDERSTORY_TEST_PROGRAMS=8"});
  std::vector<std::unique_ptr<Process>> children;
  for (int i = 0; i < 6; ++i) children.push_back(std::make_unique<Process>(worker, cold));
  for (const auto& child : children) expect_success(child->wait());
}

TEST_F(CacheTest, SurvivesProcessesKilledWhileTheyBuild) {
  const std::string place = "XDG_CACHE_HOME=" + root_.string();
  for (int i = 1; i <= 8; ++i) {
    Process child(worker, variables({place}));
    std::this_thread::sleep_for(std::chrono::milliseconds(40 * i));
    child.send(SIGKILL);
  }
  run_worker({place});
}

enum class Damage { truncated, emptied, flipped };

void damage(const fs::path& file, Damage kind) {
  const auto size = static_cast<std::streamoff>(fs::file_size(file));
  if (kind == Damage::truncated) fs::resize_file(file, static_cast<std::uintmax_t>(size / 2));
  if (kind == Damage::emptied) fs::resize_file(file, 0);
  if (kind != Damage::flipped) return;
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekg(size / 2);
  const char byte = static_cast<char>(stream.get() ^ 0x10);
  stream.seekp(size / 2);
  stream.put(byte);
}

struct DamageCase {
  const char* name;
  Damage kind;
  const char* extension;
  bool listed;  // false: the process that compiled it never came to list its checksum
};

constexpr DamageCase damage_cases[] = {
    {"truncated object", Damage::truncated, ".so", true},
    {"empty object", Damage::emptied, ".so", true},
    {"flipped bit in an object", Damage::flipped, ".so", true},
    {"truncated bitcode", Damage::truncated, ".bc", true},
    {"empty bitcode", Damage::emptied, ".bc", true},
    {"flipped bit in bitcode", Damage::flipped, ".bc", true},
    {"unlisted truncated object", Damage::truncated, ".so", false},
    {"unlisted empty object", Damage::emptied, ".so", false},
    {"unlisted truncated bitcode", Damage::truncated, ".bc", false},
    {"unlisted empty bitcode", Damage::emptied, ".bc", false},
};

TEST_F(CacheTest, DamagedEntriesAreRepairedByTheNextProcess) {
  run_worker({"POCL_CACHE_DIR=" + (root_ / "sound").string()});
  for (const DamageCase& tested : damage_cases) {
    SCOPED_TRACE(tested.name);
    const fs::path cache = root_ / tested.name;
    fs::copy(root_ / "sound", cache, fs::copy_options::recursive);
    int damaged = 0;
    for (const CacheEntry& entry : cache_entries(cache)) {
      for (const fs::path& file : entry.files) {
        if (file.extension() != tested.extension) continue;
        damage(cache / file, tested.kind);
        ++damaged;
      }
    }
    EXPECT_EQ(damaged, 2);
    EXPECT_TRUE(tested.listed || fs::remove(cache / "understory_checksums"));
    run_worker({"POCL_CACHE_DIR=" + cache.string()});
    EXPECT_EQ(repair_cache(cache), 0u) << "everything is sound again";
  }
}

TEST_F(CacheTest, SoundEntriesStay) {
  run_worker({"POCL_CACHE_DIR=" + root_.string()});
  const std::size_t entries = cache_entries(root_).size();
  EXPECT_EQ(entries, 2u);
  EXPECT_EQ(repair_cache(root_), 0u);
  ASSERT_TRUE(fs::remove(root_ / "understory_checksums"));
  EXPECT_EQ(repair_cache(root_), 0u) << "complete files are accepted without a checksum";
  EXPECT_EQ(cache_entries(root_).size(), entries);
}

TEST_F(CacheTest, OldTemporaryFilesGoYoungOnesStay) {
  std::ofstream(root_ / "tempfile_old");
  std::ofstream(root_ / "tempfile_young");
  std::ofstream(root_ / "notes.txt");
  const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(1);
  fs::last_write_time(root_ / "tempfile_old", long_ago);
  fs::last_write_time(root_ / "notes.txt", long_ago);
  repair_cache(root_);
  EXPECT_FALSE(fs::exists(root_ / "tempfile_old"));
  EXPECT_TRUE(fs::exists(root_ / "tempfile_young"));
  EXPECT_TRUE(fs::exists(root_ / "notes.txt"));
}

TEST_F(CacheTest, ClearingRemovesOnlyWhatPoclWrote) {
  run_worker({"POCL_CACHE_DIR=" + root_.string()});
  fs::create_directories(root_ / "DOCUMENTS" / "KEEP");
  std::ofstream(root_ / "letter.txt");
  remove_cache_entries(root_);
  EXPECT_TRUE(cache_entries(root_).empty());
  EXPECT_TRUE(fs::exists(root_ / "DOCUMENTS" / "KEEP"));
  EXPECT_TRUE(fs::exists(root_ / "letter.txt"));
  EXPECT_FALSE(fs::exists(root_ / "understory_checksums"));
}

TEST_F(CacheTest, IsVersionedBelowTheUsersCache) {
  run_worker({"XDG_CACHE_HOME=" + root_.string()});
  const auto first = [](const fs::path& folder) { return fs::directory_iterator(folder)->path(); };
  const fs::path version = first(root_ / "understory");
  EXPECT_THAT(version.filename().string(), testing::StartsWith("pocl-"));
  EXPECT_EQ(cache_entries(first(version)).size(), 2u);
}

TEST_F(CacheTest, FallsBackToTheTemporaryFolder) {
  run_worker({"XDG_CACHE_HOME=/dev/null/cache", "TMPDIR=" + root_.string()});
  EXPECT_TRUE(fs::exists(root_ / ("understory-" + std::to_string(geteuid()))));
}

TEST_F(CacheTest, NoPlaceAtAllIsAnError) {
  const FinishedProcess process =
      run_process(worker, variables({"XDG_CACHE_HOME=/dev/null/cache", "TMPDIR=/dev/null"}));
  EXPECT_EQ(process.exit_code, 1);
  EXPECT_THAT(process.out, testing::HasSubstr("no folder for compiled kernels: tried /dev/null/cache/understory"));
}

TEST(CacheInfo, CountsWhatLiesInTheFolder) {
  const CacheInfo info = cache_info();
  EXPECT_EQ(info.folder, cache_folder());
  EXPECT_EQ(info.programs, cache_entries(info.folder).size());
}

}  // namespace
}  // namespace understory
