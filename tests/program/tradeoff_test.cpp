// `understory tradeoff` as a user types it: its files, its front, and how it goes on after a kill.
#include <csignal>
#include <map>
#include <set>

#include "tests/program/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace understory {
namespace {

using testing::HasSubstr;

std::vector<std::string> quick(const std::filesystem::path& folder, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments = {"tradeoff", scenes_folder + "/tiny.yaml", "-o", folder.string(), "--no-bakes"};
  for (const char* option :
       {"--frames", "1", "--pixels", "300", "--rays", "64", "--rounds", "2", "--sweeps", "2", "--combinations", "4"})
    arguments.emplace_back(option);
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::size_t kept_variants(const std::filesystem::path& folder) {
  std::size_t count = 0;
  std::error_code missing;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "variants", missing))
    count += entry.path().extension() == ".cbor";
  return count;
}

/// Of a kept variant: what it took each time, ms.
std::vector<double> times_in(const std::string& variant) {
  return nlohmann::json::from_cbor(variant).at("samples").at("device_ms").get<std::vector<double>>();
}

bool clearly_wins(const nlohmann::json& a, const nlohmann::json& b) {
  const auto less = [](const nlohmann::json& one, const nlohmann::json& other, const std::string& key) {
    return one.at(key + "_high").get<double>() < other.at(key + "_low").get<double>();
  };
  return (less(a, b, "ms") && !less(b, a, "rmse")) || (less(a, b, "rmse") && !less(b, a, "ms"));
}

TEST(Tradeoff, MeasuresASceneWithEveryClassOfObject) {
  const TemporaryFolder parent;
  const std::filesystem::path folder = parent / "trade";
  const FinishedProcess finished = understory_command(quick(folder));
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  for (const char* file : {"tradeoff.md", "tradeoff.csv", "tradeoff.json", "tradeoff.png", "tradeoff.svg"})
    EXPECT_GT(std::filesystem::file_size(folder / file), 100u) << file;
  const auto table = nlohmann::json::parse(file_text(folder / "tradeoff.json"));
  EXPECT_EQ(table.at("cameras"), 2);
  const auto& rows = table.at("rows");
  std::string all_names;
  std::size_t front = 0, temporal = 0;
  for (const auto& row : rows) {
    EXPECT_TRUE(row.at("verified").get<bool>()) << row.at("name") << ": " << row.at("failure");
    EXPECT_LE(row.at("ms_low").get<double>(), row.at("ms").get<double>());
    EXPECT_LE(row.at("rmse_low").get<double>(), row.at("rmse").get<double>());
    EXPECT_LE(row.at("rmse").get<double>(), row.at("rmse_high").get<double>());
    EXPECT_GT(row.at("mib").get<double>(), 0);
    std::set<std::string> on_device, on_host;
    for (const auto& [pass, ms] : row.at("pass_ms").items()) on_device.insert(pass);
    for (const auto& [pass, ms] : row.at("pass_wall_ms").items()) {
      on_host.insert(pass);
      EXPECT_GT(ms.get<double>(), 0) << pass;
    }
    EXPECT_EQ(on_host, on_device) << "each pass by both clocks";
    all_names += row.at("name").get<std::string>() + "\n";
    front += row.at("pareto").get<bool>();
    temporal += !row.at("temporal").is_null();
    if (!row.at("pareto").get<bool>()) continue;
    for (const auto& other : rows)
      EXPECT_FALSE(other.at("pareto").get<bool>() && clearly_wins(other, row)) << other.at("name") << row.at("name");
  }
  EXPECT_GE(front, 1u);
  EXPECT_GE(temporal, 3u);
  for (const char* method : {"sphere-cap", "crown-baked", "grass-transmittance", "crown-shells", "grid-cone 16 simple",
                             "obscurance-point 33", "screen-rays 16", "size 1/2", "relaxed maths"})
    EXPECT_THAT(all_names, HasSubstr(method));
  // V is the product of its terms, so that what they predict of the whole is exact up to rounding.
  const auto& prediction = table.at("prediction");
  EXPECT_GT(prediction.at("combinations").get<int>(), 10000);
  EXPECT_GE(prediction.at("measured").get<int>(), 3);
  EXPECT_LT(prediction.at("rmse_worst").get<double>(), 1e-4);
  std::size_t pictures = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "errors"))
    pictures += entry.path().extension() == ".png";
  EXPECT_EQ(pictures, 2 * front);
}

TEST(Tradeoff, GoesOnAfterAKill) {
  const TemporaryFolder parent;
  const std::filesystem::path folder = parent / "trade";
  std::vector<std::string> arguments = quick(folder, {"--quiet"});
  arguments.insert(arguments.begin(), program_path);
  {
    Process process(arguments);
    ASSERT_TRUE(process.wait_until([&] { return kept_variants(folder) >= 5; })) << process.err();
    process.send(SIGKILL);
    process.wait();
  }
  const std::size_t kept = kept_variants(folder);
  EXPECT_FALSE(std::filesystem::exists(folder / "tradeoff.json"));
  std::map<std::filesystem::path, std::string> earlier;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "variants"))
    if (entry.path().extension() == ".cbor" && earlier.size() < 5) earlier[entry.path()] = file_text(entry.path());
  EXPECT_THAT(understory_command(quick(folder)).err, IsOneMessageWith("--resume goes on with the tradeoff in it"));
  EXPECT_EQ(understory_command(quick(folder, {"--resume", "--seed-that-is-none"})).exit_code, 2);
  const FinishedProcess other = understory_command(quick(folder, {"--resume", "--set", "wind.speed=1"}));
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, IsOneMessageWith("--resume needs the same scene"));
  const FinishedProcess resumed = understory_command(quick(folder, {"--resume", "--json"}));
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_GT(kept_variants(folder), kept);
  EXPECT_EQ(resumed.out, file_text(folder / "tradeoff.json"));
  for (const auto& [path, bytes] : earlier) {  // what was timed before is still there, later times behind it
    const auto before = times_in(bytes), after = times_in(file_text(path));
    ASSERT_GE(after.size(), before.size()) << path;
    EXPECT_TRUE(std::equal(before.begin(), before.end(), after.begin())) << path;
  }
}

TEST(Tradeoff, LeavesOtherFoldersAlone) {
  const TemporaryFolder folder;
  std::ofstream(folder / "mine.txt") << "mine";
  for (const char* option : {"--resume", "--force"}) {
    const FinishedProcess finished = understory_command(quick(folder.path(), {option}));
    EXPECT_EQ(finished.exit_code, 2);
    EXPECT_THAT(finished.err, IsOneMessageWith("not the folder of a tradeoff"));
  }
  EXPECT_EQ(file_text(folder / "mine.txt"), "mine");
}

}  // namespace
}  // namespace understory
