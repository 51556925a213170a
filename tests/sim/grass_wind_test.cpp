// Waves over grass: blades answer together nearby, and downwind after the time the gusts need to get there.
#include "sim/grass_wind.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kernels/shared/grass_bend.h"
#include "sim/random.hpp"

namespace understory {
namespace {

constexpr double pi = std::numbers::pi;

struct Meadow {
  explicit Meadow(double speed = 5, double direction = 0.6) : wind(source(speed, direction), 11) {
    response = grass_response(wind, field);
  }
  static WindSource source(double speed, double direction) {
    WindSource source;
    source.speed = speed;
    source.direction = direction;
    return source;
  }
  GrassWind at(double time) const { return grass_wind_at(wind, field, response, time, {3, -4, 1.5}); }

  GrassField field;
  Wind wind;
  ModalSeries response;
};

/// How far a blade without rest bend leans downwind over time, 16 times a second.
std::vector<double> lean(const Meadow& meadow, glm::dvec2 position, double phase = 0) {
  std::vector<double> series;
  for (int i = 0; i < 16 * 400; ++i) {
    const glm::dvec2 bend = grass_bend(meadow.at(i / 16.0), meadow.response, {position, {0, 0}, 1, phase});
    series.push_back(glm::dot(bend, meadow.wind.direction()));
  }
  return series;
}

/// Correlation of a(t) with b(t + lag), lag in samples, may be negative.
double correlation(const std::vector<double>& a, const std::vector<double>& b, int lag) {
  double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0, n = 0;
  for (int i = std::max(0, -lag); i < static_cast<int>(a.size()) - std::max(0, lag); ++i) {
    const double x = a[i], y = b[i + lag];
    sa += x, sb += y, saa += x * x, sbb += y * y, sab += x * y, ++n;
  }
  return (n * sab - sa * sb) / std::sqrt((n * saa - sa * sa) * (n * sbb - sb * sb));
}

int best_lag(const std::vector<double>& a, const std::vector<double>& b, int most) {
  int best = -most;
  for (int lag = -most; lag <= most; ++lag)
    if (correlation(a, b, lag) > correlation(a, b, best)) best = lag;
  return best;
}

TEST(GrassWaves, MoveNeighboursTogetherAndStrangersApart) {
  const Meadow meadow;
  const glm::dvec2 left(-meadow.wind.direction().y, meadow.wind.direction().x);
  const std::vector<double> here = lean(meadow, {7, 3}, 0.4);
  EXPECT_GT(correlation(here, lean(meadow, {7.1, 3.05}, 4), 0), 0.9);
  EXPECT_LT(correlation(here, lean(meadow, glm::dvec2(7, 3) + 15.0 * left), 0), 0.5);
}

TEST(GrassWaves, TravelDownwindWithTheGusts) {
  const Meadow meadow;
  const double cross = 2;
  const glm::dvec2 d = meadow.wind.direction(), left(-d.y, d.x);
  const std::vector<double> here = lean(meadow, cross * left);
  for (double distance : {5.0, 20.0, 60.0}) {
    const std::vector<double> there = lean(meadow, cross * left + distance * d);
    const double expected = distance / meadow.wind.convection_speed();
    // Wavy fronts may come early or late by 3 lateral delays.
    const double slack = 3.0 * static_cast<double>(meadow.at(0).lateral_delay) + 1.0 / 16;
    const int lag = best_lag(here, there, 400);
    EXPECT_NEAR(lag / 16.0, expected, slack) << distance << " m";
    EXPECT_GT(correlation(here, there, lag), 0.9);
  }
}

TEST(GrassWaves, HaveFrontsThatAreNotStraight) {
  const Meadow meadow;
  const glm::dvec2 d = meadow.wind.direction(), left(-d.y, d.x);
  double earliest = 0, latest = 0;
  const std::vector<double> here = lean(meadow, {0, 0});
  for (double cross = -6; cross <= 6; ++cross) {
    const double lag = best_lag(here, lean(meadow, cross * left), 40) / 16.0;
    earliest = std::min(earliest, lag), latest = std::max(latest, lag);
  }
  EXPECT_GT(latest - earliest, 0.4);  // s: some two metres at 5 m/s
}

TEST(GrassWaves, AreLargeEnoughToSee) {
  const Meadow meadow(4);
  const std::vector<double> series = lean(meadow, {0, 0});
  double sum = 0, squares = 0;
  for (double value : series) sum += value, squares += value * value;
  const double mean = sum / static_cast<double>(series.size());
  const double deviation = std::sqrt(squares / static_cast<double>(series.size()) - mean * mean);
  // A blade of 0.35 m: some centimetres at its tip, in a gentle breeze.
  EXPECT_GT(deviation * 0.35 / 2, 0.01);
  EXPECT_GT(mean, 0.1);
  EXPECT_LT(mean, 0.5);
}

TEST(GrassWind, OfStillAirLeavesEveryBladeAtRest) {
  const Meadow meadow(0);
  for (double time : {0.0, 12.3, 1e5}) {
    const glm::dvec2 bend = grass_bend(meadow.at(time), meadow.response, {{40, -7}, {0.31, -0.22}, 1.7, 2.9});
    EXPECT_EQ(bend, glm::dvec2(0.31, -0.22));
  }
}

TEST(GrassWind, StaysFiniteInAStorm) {
  for (double speed : {1e-9, 60.0, 100.0, 200.0}) {
    const Meadow meadow(speed);
    for (double time : {-1e6, 0.0, 3.3, 1e9})
      for (const glm::dvec2 position : {glm::dvec2(0), glm::dvec2(1e4, -1e4)}) {
        const glm::dvec2 bend = grass_bend(meadow.at(time), meadow.response, {position, {0, 0}, 50, 1});
        EXPECT_TRUE(std::isfinite(bend.x) && std::isfinite(bend.y));
        EXPECT_LE(glm::length(bend), 1.5);
      }
  }
}

TEST(GrassWind, RepeatsWithItsSeries) {
  const Meadow meadow;
  const GrassWind early = meadow.at(5), late = meadow.at(5 + 3 * 1024);
  EXPECT_EQ(early.sample_time, late.sample_time);
  EXPECT_EQ(early.root_offset_x, -3);
  EXPECT_EQ(early.root_offset_y, 4);
  EXPECT_EQ(early.root_offset_z, -1.5);
  EXPECT_EQ(early.series_count, 32768u);
  const std::vector<glm::vec2> pairs = interleaved(meadow.response);
  ASSERT_EQ(pairs.size(), 32768u);
  EXPECT_EQ(pairs[1234], glm::vec2(meadow.response.along[1234], meadow.response.across[1234]));
}

/// The kernel's way: shared text and a look-up by index, here in double.
glm::dvec2 shared_grass_bend(const GrassWind& wind, const std::vector<glm::vec2>& series, const BladeRoot& blade) {
  const auto look_up = [&](double sample) {
    const double whole = std::floor(sample);
    const std::size_t first = static_cast<std::size_t>(static_cast<std::int64_t>(whole)) & (wind.series_count - 1);
    return glm::mix(glm::dvec2(series[first]), glm::dvec2(series[(first + 1) & (wind.series_count - 1)]),
                    sample - whole);
  };
  const GrassGust gust = grass_gust(wind, blade.position.x, blade.position.y);
  const glm::dvec2 both =
      gust.first_share * look_up(gust.sample) + gust.second_share * look_up(gust.sample + wind.series_count / 2);
  const GrassBend bend =
      grass_bend(wind, both.x, both.y, blade.rest_bend.x, blade.rest_bend.y, blade.flexibility, blade.phase);
  return {bend.x, bend.y};
}

TEST(GrassBend, SharedTextEqualsTheReference) {
  const Meadow meadow(12, -2);
  const std::vector<glm::vec2> series = interleaved(meadow.response);
  double largest = 0;
  for (std::uint64_t i = 0; i < 1003; ++i) {
    Random random(7, stream_of("blades"), i);
    BladeRoot blade;
    blade.position = {random.uniform(-300, 300), random.uniform(-300, 300)};
    blade.rest_bend = {random.normal(0, 0.4), random.normal(0, 0.4)};
    blade.flexibility = random.uniform(0.3, 3);
    blade.phase = random.uniform(0, 2 * pi);
    const GrassWind wind = meadow.at(random.uniform(-100, 3000));
    const glm::dvec2 shared = shared_grass_bend(wind, series, blade);
    largest = std::max(largest, glm::distance(shared, grass_bend(wind, meadow.response, blade)));
  }
  EXPECT_LT(largest, 1e-4);  // sines 2e-6 off, times a delay of samples and the slope of the series
}

TEST(GrassBend, SineOfTurnsIsWithinItsStatedError) {
  double largest = 0;
  for (double turns = -30; turns < 30; turns += 1e-4)
    largest = std::max(largest, std::abs(sine_of_turns(turns) - std::sin(2 * pi * turns)));
  EXPECT_LT(largest, 2e-6);
}

}  // namespace
}  // namespace understory
