// What `understory stability` tries, with few fragments each: kernels stay finite, within [0, 1], and near double.
#include "bench/stability.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <set>

#include "tests/support/fragments.hpp"

namespace understory {
namespace {

const StabilityReport& report() {
  static const StabilityReport made = run_stability("", {.samples = 200, .relaxed = false, .filter = ""});
  return made;
}

TEST(Stability, EveryCaseHolds) {
  UNDERSTORY_NEEDS_DEVICE();
  for (const StabilityRow& row : report().rows) {
    EXPECT_TRUE(row.finite) << row.kernel << ": " << row.name;
    EXPECT_TRUE(row.in_range) << row.kernel << ": " << row.name;
    EXPECT_TRUE(row.passed) << row.kernel << ": " << row.name << ", error " << row.max_abs_error.value_or(0) << " of "
                            << row.bar << ", jump " << row.largest_jump.value_or(0) << ", fall "
                            << row.largest_fall.value_or(0);
  }
}

TEST(Stability, CoversEveryVisibilityMethod) {
  UNDERSTORY_NEEDS_DEVICE();
  std::set<std::string> kernels;
  for (const StabilityRow& row : report().rows) kernels.insert(row.kernel.substr(0, row.kernel.find('/')));
  for (const char* method : {"ambient",
                             "reeves-blau",
                             "sphere-cap",
                             "ellipsoid-cap",
                             "shells-cap",
                             "shells-cap-levels",
                             "solid-angle",
                             "solid-angle-exact",
                             "solid-angle-cosine",
                             "crown-shells",
                             "crown-transmittance",
                             "crown-field",
                             "crown-baked",
                             "grass-height",
                             "grass-transmittance",
                             "grid",
                             "grid-self-paper",
                             "grid-cone",
                             "grid-cone-paper",
                             "obscurance-line",
                             "obscurance-point",
                             "obscurance-area",
                             "screen-rays",
                             "open-dome",
                             "combine",
                             "environment",
                             "frame"})
    EXPECT_TRUE(kernels.contains(method)) << method;
}

TEST(Stability, ObscuranceWithoutNormalsSeesOccluders) {
  UNDERSTORY_NEEDS_DEVICE();
  int cases = 0;
  for (const StabilityRow& row : report().rows) {
    if (row.name != "thickness, without normals") continue;
    ++cases;
    EXPECT_LT(row.lowest, 0.8) << row.kernel;
    EXPECT_GT(row.highest, row.lowest + 0.1) << row.kernel;
    EXPECT_TRUE(row.max_abs_error) << row.kernel;
  }
  EXPECT_EQ(cases, 3);
}

TEST(Stability, CodesTellWhichAssumptionsDidNotHold) {
  UNDERSTORY_NEEDS_DEVICE();
  std::map<std::uint32_t, std::set<std::string>> seen;
  for (const StabilityRow& row : report().rows)
    for (const auto& [code, count] : row.validity) seen[code].insert(row.kernel);
  EXPECT_THAT(seen[2], testing::Contains("check-fragments"));
  EXPECT_THAT(seen[4], testing::Contains("check-fragments"));
  EXPECT_THAT(seen[8], testing::IsSupersetOf({"sphere-cap", "ellipsoid-cap", "reeves-blau", "shells-cap",
                                              "crown-transmittance", "crown-field", "grass-height"}));
  EXPECT_THAT(seen[16],
              testing::IsSupersetOf({"solid-angle-cosine", "grid", "grid-cone/union", "grid-cone-paper/merge"}));
  EXPECT_THAT(seen[32], testing::Contains("obscurance-line"));
  EXPECT_THAT(seen[64], testing::Contains("obscurance-area"));
  EXPECT_THAT(seen[128], testing::IsSupersetOf({"grid", "grid-cone/merge"}));
}

TEST(Stability, JsonHasTheKeysThatScriptsRelyOn) {
  UNDERSTORY_NEEDS_DEVICE();
  const nlohmann::json json = nlohmann::json::parse(stability_json(report()));
  EXPECT_EQ(json.at("cases"), report().rows.size());
  EXPECT_EQ(json.at("failures"), 0);
  for (const nlohmann::json& row : json.at("rows"))
    for (const char* key : {"kernel", "case", "max_abs_error", "finite", "in_range"}) EXPECT_TRUE(row.contains(key));
}

}  // namespace
}  // namespace understory
