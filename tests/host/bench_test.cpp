// The benchmarks' own arithmetic, and that every kernel benchmark measures a right answer. Small sizes: no speed here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "bench/report.hpp"
#include "bench/timing.hpp"
#include "sim/error.hpp"

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

TEST(CompareResults, CallsOnlySeparateIntervalsAChange) {
  const auto changes = compare_results(
      {result("same", 9, 10, 11), result("slower", 9, 10, 11), result("gone", 1, 1, 1), result("wrong", 1, 1, 1)},
      {result("same", 10, 11, 12), result("slower", 19, 20, 21), result("wrong", 0, 0, 0, false),
       result("new", 1, 1, 1)});
  ASSERT_EQ(changes.size(), 2u);
  EXPECT_FALSE(changes[0].changed);
  EXPECT_TRUE(changes[1].changed);
  EXPECT_EQ(changes[1].ratio, 2);
}

TEST(KernelBenchmarks, MeasureRightAnswers) {
  BenchOptions options;
  options.fragments = 100003;
  options.repetitions = 2;
  options.filter = "kernel/";
  const BenchReport report = run_bench(options);
  EXPECT_GE(report.results.size(), 11u);
  EXPECT_GT(report.roofs.at("copy_gb_per_s"), 0);
  EXPECT_GT(report.roofs.at("multiply_add_gflop_per_s"), 0);
  for (const BenchResult& result : report.results) {
    EXPECT_TRUE(result.verified) << result.name << " is off by " << result.max_error;
    EXPECT_GT(result.items_per_s, 0) << result.name;
    EXPECT_LE(result.low_ms, result.median_ms) << result.name;
    EXPECT_THAT(result.bound_by, testing::AnyOf("memory", "arithmetic", "latency")) << result.name;
  }
}

}  // namespace
}  // namespace understory
