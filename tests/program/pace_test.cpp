// The pace of an adaptive run, on a clock that the test makes up: it keeps the time, uses what there is, and does not
// flip to and fro.
#include "host/app/pace.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "tests/support/errors.hpp"

namespace understory {
namespace {

const std::vector<double> predicted = {2, 4, 6, 10};  // ms

/// What happens when frame i with choice k takes clock(i, k) ms.
struct Ran {
  std::vector<std::size_t> levels;
  std::vector<double> ms;
  std::size_t switches = 0;
};

Ran run_frames(int frames, double max_ms, const std::function<double(int, std::size_t)>& clock) {
  Pace pace(predicted, max_ms);
  Ran ran;
  for (int i = 0; i < frames; ++i) {
    ran.levels.push_back(pace.level());
    ran.ms.push_back(clock(i, pace.level()));
    pace.add(ran.ms.back());
  }
  ran.switches = pace.switches();
  return ran;
}

TEST(Pace, StaysWhereThePredictionHolds) {
  const Ran ran = run_frames(500, 7, [](int, std::size_t level) { return predicted[level]; });
  EXPECT_EQ(ran.switches, 0u);
  EXPECT_EQ(ran.levels.back(), 2u) << "the slowest that fits";
}

TEST(Pace, StaysDespiteNoiseOfSingleFrames) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 0.04);
  const Ran ran = run_frames(2000, 7, [&](int, std::size_t level) { return predicted[level] * (1 + noise(random)); });
  EXPECT_EQ(ran.switches, 0u);
}

TEST(Pace, IgnoresOneSlowFrame) {
  const Ran ran = run_frames(200, 7, [](int i, std::size_t level) { return predicted[level] * (i == 100 ? 1.5 : 1); });
  EXPECT_EQ(ran.switches, 0u);
}

TEST(Pace, StepsDownUnderLoadAndUpAgainAfterIt) {
  const Ran ran =
      run_frames(400, 7, [](int i, std::size_t level) { return predicted[level] * (i >= 100 && i < 200 ? 2.5 : 1); });
  EXPECT_EQ(ran.levels[99], 2u);
  for (int i = 115; i < 200; ++i) EXPECT_LE(ran.ms[static_cast<std::size_t>(i)], 7) << "frame " << i;
  EXPECT_EQ(ran.levels[199], 0u) << "2.5 times 2 ms fits, 2.5 times 4 ms does not";
  EXPECT_EQ(ran.levels.back(), 2u);
  EXPECT_LE(ran.switches, 4u) << "two steps each way";
}

TEST(Pace, StaysAtTheFastestWhenNothingFits) {
  const Ran ran = run_frames(300, 1, [](int, std::size_t level) { return predicted[level]; });
  EXPECT_EQ(ran.levels.back(), 0u);
  EXPECT_EQ(ran.switches, 0u);
}

TEST(Pace, TriesAChoiceThatDoesNotHoldEverMoreSeldom) {
  // The slowest choice was measured at 10 ms and takes 20: each attempt fails.
  const int frames = 4096;
  const Ran ran = run_frames(frames, 12, [](int, std::size_t level) { return level == 3 ? 20 : predicted[level]; });
  EXPECT_LE(ran.switches, 2 * std::log2(frames));
  const auto late = std::count(ran.levels.begin() + frames / 2, ran.levels.end(), 3u);
  EXPECT_LE(late, 12) << "of the second half";
}

TEST(Pace, DoesNotFlipWithALoadThatComesAndGoes) {
  for (const int period : {2, 6, 20, 40, 100}) {
    const int frames = 8192;
    const Ran ran = run_frames(
        frames, 7, [&](int i, std::size_t level) { return predicted[level] * (i / (period / 2) % 2 == 0 ? 1 : 1.6); });
    EXPECT_LE(ran.switches, 4 * std::log2(frames)) << "period " << period;
  }
}

TEST(Pace, IsTheSameForTheSameTimes) {
  const auto clock = [](int i, std::size_t level) { return predicted[level] * (1 + 0.5 * std::sin(0.05 * i)); };
  EXPECT_EQ(run_frames(1000, 7, clock).levels, run_frames(1000, 7, clock).levels);
}

TEST(Pace, RefusesTimesThatAreNone) {
  const std::vector<std::pair<std::vector<double>, double>> wrong = {{{}, 1}, {{2, 1}, 1}, {{0, 1}, 1}, {{1, 2}, 0}};
  for (const auto& [times, max_ms] : wrong)
    EXPECT_FALSE(message_of(ErrorKind::unexpected, [&] { Pace(times, max_ms); }).empty());
}

}  // namespace
}  // namespace understory
