// What an output folder promises: it is refused when it holds something else, and after a kill at any moment it knows
// exactly which frames are done.
#include "host/app/run_folder.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "host/app/checksum.hpp"
#include "sim/error.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

class RunFolderTest : public testing::Test {
 protected:
  void SetUp() override { fs::remove_all(path_); }
  void TearDown() override { fs::remove_all(path_); }

  void put(const std::string& name, const std::string& text) { std::ofstream(path_ / name) << text; }

  FrameRecord finished_frame(int index) {
    FrameRecord frame;
    frame.index = index;
    frame.time_s = index / 24.0;
    frame.ms = 12.5;
    frame.passes = {{"sphere-cap", 1.25}};
    const std::string name = frame_file_name("frame", index, "exr"), text = "pixels of " + std::to_string(index);
    put(name, text);
    frame.sha256 = frame.files[name] = sha256_of_text(text);
    frame.validity = {{1, 100}, {16, 3}};
    return frame;
  }

  static RunRecord record() {
    RunRecord run;
    run.version = "0.1.0";
    run.scene_sha256 = "abc";
    run.device = R"({"name":"cpu"})";
    run.width = 81;
    run.height = 53;
    run.dumps = {"exr"};
    run.plan = {"pose_mesh", "combine"};
    return run;
  }

  ErrorKind kind_of_failure(ExistingRun existing) {
    try {
      RunFolder folder(path_, existing);
    } catch (const Error& error) {
      return error.kind();
    }
    ADD_FAILURE() << "no error";
    return ErrorKind::unexpected;
  }

  const fs::path path_ = fs::path(testing::TempDir()) / ("run folder " + std::to_string(::getpid()));
};

TEST(Checksum, AgreesWithTheStandard) {  // FIPS 180-4, examples of SHA-256
  EXPECT_EQ(sha256_of_text("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of_text(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST_F(RunFolderTest, RefusesAFolderThatIsNotEmpty) {
  fs::create_directories(path_);
  put("thesis.tex", "precious");
  EXPECT_EQ(kind_of_failure(ExistingRun::refuse), ErrorKind::usage);
  EXPECT_EQ(std::distance(fs::directory_iterator(path_), {}), 1) << "a refusal leaves nothing behind";
}

TEST_F(RunFolderTest, ReplacesOnlyFilesOfARun) {
  fs::create_directories(path_);
  for (const char* name : {"thesis.tex", "frame_notes.txt", "frame_0001.exr", "visibility_0001.png", "movie.ogv",
                           ".frame_0002.tmp-77.exr", ".thesis.tmp-77.tex"})
    put(name, "x");
  RunFolder folder(path_, ExistingRun::replace);
  EXPECT_TRUE(fs::exists(path_ / "frame_0001.exr")) << "nothing goes before the new run has begun";
  folder.write(record());
  std::vector<std::string> left;
  for (const auto& entry : fs::directory_iterator(path_)) left.push_back(entry.path().filename());
  EXPECT_THAT(left, testing::UnorderedElementsAre("thesis.tex", "frame_notes.txt", ".thesis.tmp-77.tex", "frames.jsonl",
                                                  "run.json"));
}

TEST_F(RunFolderTest, LeavesNoTraceOfARunThatNeverBegan) {
  { RunFolder folder(path_, ExistingRun::refuse); }
  EXPECT_FALSE(fs::exists(path_));
  fs::create_directories(path_);
  { RunFolder folder(path_, ExistingRun::refuse); }
  EXPECT_TRUE(fs::is_empty(path_)) << "a folder that was there stays";
}

TEST_F(RunFolderTest, IsWrittenByOneProcessAtATime) {
  RunFolder folder(path_, ExistingRun::refuse);
  EXPECT_EQ(kind_of_failure(ExistingRun::resume), ErrorKind::usage);
}

TEST_F(RunFolderTest, FailsWhereNoFolderCanBe) {
  fs::create_directories(path_);
  put("file", "");
  try {
    RunFolder folder(path_ / "file" / "out", ExistingRun::refuse);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input_output);
    EXPECT_THAT(error.what(), testing::HasSubstr("file/out"));
  }
}

TEST_F(RunFolderTest, KnowsAfterAKillWhichFramesAreDone) {
  {
    RunFolder folder(path_, ExistingRun::refuse);
    folder.write(record());
    for (int index : {0, 1, 2, 3}) folder.add(finished_frame(index));
  }
  put("frame_0001.exr", "damaged");
  fs::remove(path_ / "frame_0002.exr");
  put(".frame_0004.tmp-99.exr", "half a frame");
  std::ofstream(path_ / "frames.jsonl", std::ios::app) << R"({"index":4,"time_s":0.16)";

  RunFolder folder(path_, ExistingRun::resume);
  ASSERT_TRUE(folder.earlier());
  EXPECT_TRUE(differences(*folder.earlier(), record()).empty());
  EXPECT_THAT(folder.earlier()->frames, testing::ElementsAre(testing::Key(0), testing::Key(3)));
  EXPECT_FALSE(fs::exists(path_ / ".frame_0004.tmp-99.exr"));
  EXPECT_EQ(folder.earlier()->frames.at(3).validity.at(16), 3u);
}

TEST_F(RunFolderTest, SurvivesASecondKillAfterAResume) {
  {
    RunFolder folder(path_, ExistingRun::refuse);
    folder.write(record());
    folder.add(finished_frame(0));
    std::ofstream(path_ / "frames.jsonl", std::ios::app) << "{\"cut";
  }
  {
    RunFolder folder(path_, ExistingRun::resume);
    folder.write(*folder.earlier());
    folder.add(finished_frame(1));
  }
  RunFolder folder(path_, ExistingRun::resume);
  EXPECT_THAT(folder.earlier()->frames, testing::ElementsAre(testing::Key(0), testing::Key(1)));
}

TEST_F(RunFolderTest, FinishesWithOneRecordOfEverything) {
  RunRecord run = record();
  RunFolder folder(path_, ExistingRun::refuse);
  folder.write(run);
  for (int index : {1, 0}) {
    run.frames[index] = finished_frame(index);
    folder.add(run.frames[index]);
  }
  folder.finish(run);
  EXPECT_FALSE(fs::exists(path_ / "frames.jsonl"));
  const auto json = nlohmann::json::parse(std::ifstream(path_ / "run.json"));
  EXPECT_EQ(json.at("frames").size(), 2u);
  EXPECT_EQ(json.at("frames")[0].at("index"), 0) << "frames in order";
  EXPECT_EQ(json.at("validity").at("1"), 200);
  EXPECT_EQ(json.at("plan"), nlohmann::json({"pose_mesh", "combine"}));
}

TEST_F(RunFolderTest, TellsWhatForbidsAResume) {
  RunRecord other = record();
  other.scene_sha256 = "def";
  other.supersample = 2;
  EXPECT_THAT(differences(record(), other), testing::ElementsAre(testing::HasSubstr("was abc, is def"),
                                                                 testing::HasSubstr("supersample was 1, is 2")));
}

TEST_F(RunFolderTest, ResumesOnTheSameDeviceWithOtherFreeMemory) {
  RunRecord before = record(), after = record();
  before.device = R"({"name":"cpu","compute_units":2,"memory_mib":8282})";
  after.device = R"({"name":"cpu","compute_units":1,"memory_mib":6746})";
  EXPECT_TRUE(differences(before, after).empty());
  after.device = R"({"name":"gpu","compute_units":2,"memory_mib":8282})";
  EXPECT_EQ(differences(before, after).size(), 1u);
}

TEST_F(RunFolderTest, RefusesADamagedRecord) {
  fs::create_directories(path_);
  put("run.json", "{\"understory\": 3");
  EXPECT_EQ(kind_of_failure(ExistingRun::resume), ErrorKind::invalid_input);
}

}  // namespace
}  // namespace understory
