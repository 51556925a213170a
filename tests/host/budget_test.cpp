// The choice by a budget, on made-up tables: the promise is what statistics says, the choice is the best that keeps it.
#include "bench/budget.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/errors.hpp"

namespace understory {
namespace {

constexpr int many_frames = 1000;

ViewError view_of(int camera, int frame, double high) {
  ViewError view;
  view.camera = camera;
  view.frame = frame;
  view.all.pixels = 100;
  view.all.high = high;
  view.all.rmse = 0.95 * high;
  return view;
}

/// A row whose frames all err alike, by both cameras.
TradeoffRow row_of(const std::string& name, double ms, double error) {
  TradeoffRow row;
  row.name = name;
  row.verified = true;
  row.ms = {ms, 0.9 * ms, 1.1 * ms};
  row.frame_ms = ms + 10;
  for (const int camera : {0, 1})
    for (const int frame : {100, 500, 900}) row.views.push_back(view_of(camera, frame, error));
  row.error.rmse = error;
  return row;
}

TradeoffTable table_of(std::vector<TradeoffRow> rows) {
  TradeoffTable table;
  table.scene = "made up";
  table.frames = {100, 500, 900};
  table.rows = std::move(rows);
  return table;
}

TEST(Budget, KnowsStudentsDistribution) {
  // Integrates the density, whose constant is Gamma((n+1)/2) / (sqrt(n pi) Gamma(n/2)), up to the point.
  for (const int n : {1, 2, 3, 4, 6, 10, 30, 1000}) {
    const double constant = std::exp(std::lgamma((n + 1) / 2.0) - std::lgamma(n / 2.0)) / std::sqrt(n * M_PI);
    const double end = student_t95(n);
    const int steps = 20000;
    double below = 0.5;
    for (int i = 0; i < steps; ++i) {
      const double t = (i + 0.5) * end / steps;
      below += constant * std::pow(1 + t * t / n, -(n + 1) / 2.0) * end / steps;
    }
    EXPECT_NEAR(below, 0.95, 1e-4) << n << " degrees of freedom";
  }
}

TEST(Budget, PromisesWhatNineteenOfTwentyNewFramesKeep) {
  std::mt19937 random(11);
  const double means[] = {0.12, 0.15}, deviation = 0.01;
  int kept = 0, tried = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    std::vector<ViewError> views;
    const auto draw = [&](int camera) { return std::normal_distribution<double>(means[camera], deviation)(random); };
    for (const int camera : {0, 1})
      for (const int frame : {1, 2, 3, 4}) views.push_back(view_of(camera, frame, draw(camera)));
    const double promise = promised_rmse(views, many_frames);
    kept += draw(1) <= promise;  // the worse camera
    ++tried;
  }
  EXPECT_GE(double(kept) / tried, 0.95 - 0.01);
}

TEST(Budget, PromisesNoLessThanTheWorstFrameAndJustThatWhenNoneIsUnseen) {
  const std::vector<ViewError> views = {view_of(0, 0, 0.1), view_of(0, 1, 0.1), view_of(0, 2, 0.16)};
  EXPECT_GT(promised_rmse(views, 4), 0.16);
  EXPECT_DOUBLE_EQ(promised_rmse(views, 3), 0.16);
  EXPECT_DOUBLE_EQ(promised_rmse({view_of(0, 0, 0.1), view_of(1, 0, 0.2)}, 48), 0.2) << "no scatter is known";
  std::vector<ViewError> steady(4, view_of(0, 0, 0.1));
  for (int i = 0; i < 4; ++i) steady[static_cast<std::size_t>(i)].frame = i;
  EXPECT_NEAR(promised_rmse(steady, 48), 0.1, 1e-12) << "frames that all err alike need no margin";
}

TEST(Budget, LeavesOutViewsThatSeeNothing) {
  ViewError empty = view_of(1, 2, 0.9);
  empty.all.pixels = 0;
  EXPECT_DOUBLE_EQ(promised_rmse({view_of(0, 1, 0.1), empty}, 48), 0.1);
}

TEST(Budget, ChoosesTheFastestThatKeepsTheError) {
  const TradeoffTable table =
      table_of({row_of("rough", 1, 0.3), row_of("fair", 2, 0.2), row_of("good", 4, 0.1), row_of("waste", 8, 0.15)});
  EXPECT_EQ(cheapest_within(table, many_frames, 0.25).row, 1u);
  EXPECT_EQ(cheapest_within(table, many_frames, 0.199).row, 2u);
  EXPECT_EQ(cheapest_within(table, many_frames, 0.5).row, 0u);
  const BudgetChoice none = cheapest_within(table, many_frames, 0.05);
  EXPECT_EQ(none.row, no_row);
  EXPECT_EQ(none.nearest, 2u);
  EXPECT_NEAR(none.promise.rmse, 0.1, 1e-9);
}

TEST(Budget, DoubtsWhatKeptTheErrorSoFarButDoesNotPromiseIt) {
  TradeoffRow scattered = row_of("scattered", 1, 0.2);
  scattered.views[0].all.high = 0.24;
  TradeoffTable table = table_of({row_of("rough", 0.5, 0.3), scattered, row_of("good", 4, 0.1)});
  EXPECT_EQ(cheapest_within(table, many_frames, 0.25).row, 2u);
  EXPECT_EQ(doubtful_rows(table, many_frames, 0.25, 2), std::vector<std::size_t>{1});
  EXPECT_TRUE(doubtful_rows(table, many_frames, 0.23, 2).empty()) << "it erred more than that already";
  EXPECT_TRUE(doubtful_rows(table, many_frames, 0.5, 1).empty()) << "promised";
  table.rows[2].ms.median = 1.02;
  EXPECT_TRUE(doubtful_rows(table, many_frames, 0.25, 2).empty()) << "hardly faster than the choice";
  EXPECT_EQ(doubtful_rows(table, many_frames, 0.25, no_row), std::vector<std::size_t>{1});
}

TEST(Budget, ChoosesTheMostAccurateThatKeepsTheTime) {
  const TradeoffTable table =
      table_of({row_of("rough", 1, 0.3), row_of("fair", 2, 0.2), row_of("good", 4, 0.1), row_of("waste", 8, 0.15)});
  EXPECT_EQ(most_accurate_within(table, many_frames, 100).row, 2u);
  // A frame takes 10 ms of drawing and up to 1.1 times the shading.
  EXPECT_EQ(most_accurate_within(table, many_frames, 14.3).row, 1u);
  EXPECT_EQ(most_accurate_within(table, many_frames, 14.5).row, 2u);
  const BudgetChoice none = most_accurate_within(table, many_frames, 11);
  EXPECT_EQ(none.row, no_row);
  EXPECT_EQ(none.nearest, 0u) << "the fastest";
}

TEST(Budget, StepsGetSlowerAndMoreAccurate) {
  const TradeoffTable table =
      table_of({row_of("rough", 1, 0.3), row_of("worse", 2, 0.4), row_of("good", 4, 0.1), row_of("waste", 8, 0.15)});
  EXPECT_EQ(steps_of_accuracy(table, many_frames), (std::vector<std::size_t>{0, 2}));
}

TEST(Budget, RunsNothingThatIsWrongSmallOrRelaxed) {
  TradeoffRow wrong = row_of("wrong", 1, 0.1), small = wrong, relaxed = wrong;
  wrong.verified = false;
  small.variant.shrink = 2;
  relaxed.variant.relaxed_maths = true;
  const TradeoffTable table = table_of({wrong, small, relaxed, row_of("sound", 5, 0.2)});
  EXPECT_EQ(cheapest_within(table, many_frames, 0.5).row, 3u);
  const TradeoffTable nothing = table_of({wrong, small, relaxed});
  EXPECT_FALSE(message_of(ErrorKind::unexpected, [&] { cheapest_within(nothing, many_frames, 0.5); }).empty());
}

TEST(Budget, SpreadsFramesOverThoseThatNobodyUsed) {
  EXPECT_EQ(unused_frames(10, {5}, 3), (std::vector<int>{1, 4, 8}));
  EXPECT_EQ(unused_frames(3, {0, 1, 2}, 3), std::vector<int>{});
  EXPECT_EQ(unused_frames(4, {1}, 9), (std::vector<int>{0, 2, 3}));
}

}  // namespace
}  // namespace understory
