// The benchmarks' own arithmetic, and that every kernel benchmark measures a right answer. Small sizes: no speed here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numeric>
#include <set>

#include "bench/energy.hpp"
#include "bench/kernel_costs.hpp"
#include "bench/report.hpp"
#include "bench/timing.hpp"
#include "sim/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace understory {
namespace {

TEST(Spread95, IsTheMedianAndItsOrderStatistics) {
  std::vector<double> samples(99);
  std::iota(samples.begin(), samples.end(), 1.0);
  std::reverse(samples.begin() + 30, samples.end());
  const Spread95 spread = spread_of(samples);
  EXPECT_EQ(spread.median, 50);
  EXPECT_EQ(spread.low, 40);  // n = 99: ranks 40 and 60 enclose the median with 95 %
  EXPECT_EQ(spread.high, 60);
  EXPECT_EQ(spread_of({3, 1}).median, 2);
  EXPECT_EQ(spread_of({7}).low, 7);
  EXPECT_THROW(spread_of({}), Error);
}

BenchResult result(const std::string& name, double low, double median, double high, bool verified = true) {
  BenchResult result;
  result.name = name;
  result.low_ms = low;
  result.median_ms = median;
  result.high_ms = high;
  result.verified = verified;
  return result;
}

TEST(CompareResults, JudgesByIntervals) {
  using Verdict = BenchChange::Verdict;
  const auto changes =
      compare_results({result("same", 9.9, 10, 10.1), result("slower", 9, 10, 11), result("faster", 9, 10, 11),
                       result("overlapping", 9, 10, 11), result("apart by a little", 10, 10.1, 10.2),
                       result("gone", 1, 1, 1), result("wrong", 1, 1, 1)},
                      {result("same", 9.9, 10, 10.2), result("slower", 19, 20, 21), result("faster", 4, 5, 6),
                       result("overlapping", 10, 11, 12), result("apart by a little", 10.3, 10.45, 10.6),
                       result("wrong", 0, 0, 0, false), result("new", 1, 1, 1)});
  ASSERT_EQ(changes.size(), 5u);
  EXPECT_EQ(changes[0].verdict, Verdict::same);
  EXPECT_EQ(changes[1].verdict, Verdict::slower);
  EXPECT_EQ(changes[1].ratio, 2);
  EXPECT_NEAR(changes[1].low, 19.0 / 11, 1e-12);
  EXPECT_NEAR(changes[1].high, 21.0 / 9, 1e-12);
  EXPECT_EQ(changes[2].verdict, Verdict::faster);
  EXPECT_EQ(changes[3].verdict, Verdict::undecided);
  EXPECT_EQ(changes[4].verdict, Verdict::undecided) << "no more than same_within apart, and not known to be within";
}

TEST(TimeInTurn, StopsAsTheRuleSays) {
  Device device;
  int runs = 0;
  const auto nothing = [&] { ++runs; };
  EXPECT_EQ(time_in_turn(device, {nothing}, exactly(5)).front().runs, 5);
  EXPECT_EQ(runs, 6) << "the first is not timed";
  // Any interval is narrow enough for a precision of a thousand.
  EXPECT_EQ(time_in_turn(device, {nothing}, {7, 100, 1000, 10, true}).front().runs, 7);
  // None is for a negative one.
  EXPECT_EQ(time_in_turn(device, {nothing}, {3, 40, -1, 10, true}).front().runs, 40);
  EXPECT_EQ(time_in_turn(device, {nothing}, {3, 40, -1, 0, true}).front().runs, 3);
}

TEST(EnergyMeter, ReadsPackagesAndTheirWraps) {
  const TemporaryFolder folder;
  const auto counter = [&](const std::string& name, std::uint64_t value) {
    std::filesystem::create_directories(folder / name);
    std::ofstream(std::filesystem::path(folder / name) / "energy_uj") << value << '\n';
    std::ofstream(std::filesystem::path(folder / name) / "max_energy_range_uj") << 10'000'000 << '\n';
  };
  counter("intel-rapl:0", 9'000'000);
  counter("intel-rapl:1", 1'000'000);
  counter("intel-rapl:0:0", 500);  // a part of the first
  EnergyMeter meter(std::filesystem::path(folder / "."));
  ASSERT_TRUE(meter.readable());
  EXPECT_EQ(meter.description(), "RAPL, 2 packages");
  meter.start();
  counter("intel-rapl:0", 2'000'000);  // wrapped
  counter("intel-rapl:1", 1'500'000);
  counter("intel-rapl:0:0", 9'000'000);
  EXPECT_NEAR(meter.joules(), 3 + 0.5, 1e-9);
}

TEST(EnergyMeter, SaysWhyThereIsNothingToRead) {
  const TemporaryFolder folder;
  EnergyMeter meter(std::filesystem::path(folder / "absent"));
  EXPECT_FALSE(meter.readable());
  EXPECT_THAT(meter.description(), testing::HasSubstr("not readable here: no RAPL counters in"));
  meter.start();
  EXPECT_EQ(meter.joules(), 0);
}

TEST(KernelBenchmarks, MeasureRightAnswers) {
  BenchOptions options;
  options.fragments = {4096};
  options.repetitions = 2;
  options.filter = "kernel/";
  const BenchReport report = run_bench(options);
  for (const char* roof : {"copy_gb_per_s", "triad_gb_per_s", "multiply_add_gflop_per_s", "exp_g_per_s",
                           "gather_g_per_s", "gather_far_g_per_s", "atomic_g_per_s"})
    EXPECT_GT(report.roofs.at(roof), 0) << roof;
  std::set<std::string> names;
  for (const BenchResult& result : report.results) {
    EXPECT_TRUE(names.insert(result.name).second) << result.name << " twice";
    EXPECT_TRUE(result.verified) << result.name << " is off by " << result.max_error;
    EXPECT_GT(result.items_per_s, 0) << result.name;
    EXPECT_LE(result.low_ms, result.median_ms) << result.name;
    if (result.shares.empty()) continue;  // a part of another result
    EXPECT_THAT(result.bound_by, testing::AnyOf("memory", "arithmetic", "exp", "gather", "atomic")) << result.name;
    EXPECT_EQ(result.roof_share, result.shares.at(result.bound_by)) << result.name;
  }
  for (const KernelCost& cost : kernel_costs()) {
    const std::string name = "kernel/" + std::string(cost.kernel);
    EXPECT_TRUE(names.contains(name)) << name << " has a cost and no result";
  }
  EXPECT_TRUE(names.contains("kernel/solid-angle-cosine/list_tile_spheres"));
}

TEST(KernelBenchmarks, NameTheSmallerSizes) {
  BenchOptions options;
  options.fragments = {4096, 20011, 1 << 20};
  options.repetitions = 1;
  options.filter = "kernel/open-dome";
  std::vector<std::string> names;
  for (const BenchResult& result : run_bench(options).results) names.push_back(result.name);
  EXPECT_THAT(names, testing::ElementsAre("kernel/open-dome", "kernel/open-dome/20011", "kernel/open-dome/4Ki"));
}

}  // namespace
}  // namespace understory
