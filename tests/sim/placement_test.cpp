// Chance and the scatter of plants: spacing kept, region full, nothing depends on what else the scene holds.
#include "sim/placement.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/random.hpp"
#include "tests/support/errors.hpp"

namespace understory {
namespace {

const Admissible anywhere = [](glm::dvec2) { return true; };

double closest_pair(const std::vector<glm::dvec2>& points) {
  double closest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) closest = std::min(closest, glm::distance(points[i], points[j]));
  return closest;
}

PlantPlacement scattered(int count) {
  PlantPlacement placement;
  placement.species = "birch";
  placement.scatter = true;
  placement.region = {{-20, 5}, {25, 41}};
  placement.spacing = 3;
  placement.count = count;
  return placement;
}

TEST(Random, UniformAndNormalHaveTheirMoments) {
  double sum = 0, square = 0, uniform = 0;
  const int draws = 200'000;
  for (int i = 0; i < draws; ++i) {
    Random random(7, stream_of("test"), i);
    const double x = random.normal();
    EXPECT_LE(std::abs(x), 6);
    sum += x;
    square += x * x;
    uniform += random.uniform();
  }
  // Four standard errors.
  EXPECT_NEAR(sum / draws, 0, 4 / std::sqrt(draws));
  EXPECT_NEAR(square / draws, 1, 4 * std::sqrt(2.0 / draws));
  EXPECT_NEAR(uniform / draws, 0.5, 4 * std::sqrt(1.0 / 12 / draws));
}

TEST(Random, SeedStreamAndIndexEachChangeEveryDraw) {
  const std::uint64_t draw = Random(1, 2, 3).bits();
  EXPECT_NE(draw, Random(2, 2, 3).bits());
  EXPECT_NE(draw, Random(1, 3, 3).bits());
  EXPECT_NE(draw, Random(1, 2, 4).bits());
  EXPECT_EQ(draw, Random(1, 2, 3).bits());
  // Neighbouring indices are unrelated: their bits differ in about half of 64 places.
  double differing = 0;
  for (int i = 0; i < 4096; ++i)
    differing += std::popcount(Random(1, 2, i).bits() ^ Random(1, 2, i + 1).bits()) / 4096.0;
  EXPECT_NEAR(differing, 32, 4 * 4.0 / 64);
}

TEST(Scatter, KeepsItsSpacingAndLeavesNoRoom) {
  const Region region{{-20, 5}, {25, 41}};
  const auto points = scatter(region, 3, 11, 1, anywhere);
  EXPECT_GE(closest_pair(points), 3);
  for (glm::dvec2 point : points) EXPECT_TRUE(region.contains(point));
  // Nearly every place lies within the spacing of a plant.
  Random random(3, 1);
  int free = 0;
  for (int i = 0; i < 10'000; ++i) {
    const glm::dvec2 at{random.uniform(-20, 25), random.uniform(5, 41)};
    free += std::none_of(points.begin(), points.end(), [&](glm::dvec2 p) { return glm::distance(p, at) < 3; });
  }
  EXPECT_LT(free, 100);
}

TEST(Scatter, ReachesPiecesOfGroundThatDoNotTouch) {
  const auto points = scatter({{0, 0}, {100, 10}}, 2, 1, 1, [](glm::dvec2 p) { return p.x < 20 || p.x > 80; });
  const auto right = std::count_if(points.begin(), points.end(), [](glm::dvec2 p) { return p.x > 80; });
  EXPECT_NEAR(double(right) / double(points.size()), 0.5, 0.1);
}

TEST(Place, TakesTheCountAskedForSpreadOverTheRegion) {
  const auto plants = place(scattered(37), 5, 9, anywhere);
  ASSERT_EQ(plants.size(), 37u);
  glm::dvec2 mean(0);
  for (const PlacedPlant& plant : plants) {
    mean += plant.at / 37.0;
    EXPECT_GE(plant.scale, 0.8);
    EXPECT_LE(plant.scale, 1.2);
    EXPECT_GE(plant.yaw, 0);
    EXPECT_LT(plant.yaw, 2 * std::numbers::pi);
    EXPECT_GE(plant.delay, 0);
    EXPECT_LT(plant.delay, longest_plant_delay);
  }
  EXPECT_NEAR(mean.x, 2.5, 4 * 45 / std::sqrt(12.0 * 37));
  EXPECT_NEAR(mean.y, 23, 4 * 36 / std::sqrt(12.0 * 37));
}

TEST(Place, IsAFunctionOfSeedAndStream) {
  const auto first = place(scattered(20), 5, 9, anywhere), again = place(scattered(20), 5, 9, anywhere);
  const auto other_seed = place(scattered(20), 6, 9, anywhere), other_stream = place(scattered(20), 5, 10, anywhere);
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(first[i].at, again[i].at);
    EXPECT_EQ(first[i].yaw, again[i].yaw);
    EXPECT_EQ(first[i].delay, again[i].delay);
    EXPECT_NE(first[i].at, other_seed[i].at);
    EXPECT_NE(first[i].at, other_stream[i].at);
  }
}

TEST(Place, ByHandTakesSpotsAsWritten) {
  PlantPlacement placement;
  placement.species = "oak";
  placement.spots = {{{1, 2}, 0.5, 1.25}, {{-3, 4}, 0, 1}};
  const auto plants = place(placement, 1, 1, anywhere);
  ASSERT_EQ(plants.size(), 2u);
  EXPECT_EQ(plants[0].at, glm::dvec2(1, 2));
  EXPECT_EQ(plants[0].yaw, 0.5);
  EXPECT_EQ(plants[0].scale, 1.25);
  EXPECT_NE(plants[0].delay, plants[1].delay);
}

TEST(Place, SaysWhatDoesNotFit) {
  const std::string crowded = message_of(ErrorKind::invalid_input, [] { place(scattered(500), 1, 1, anywhere); });
  EXPECT_THAT(crowded, testing::AllOf(testing::HasSubstr("of 500 `birch`"), testing::HasSubstr("`spacing`")));
  PlantPlacement beside;
  beside.species = "oak";
  beside.spots = {{{70, -2.5}, 0, 1}};
  EXPECT_THAT(message_of(ErrorKind::invalid_input, [&] { place(beside, 1, 1, [](glm::dvec2 p) { return p.x < 50; }); }),
              testing::HasSubstr("`oak` at [70, -2.5]"));
}

}  // namespace
}  // namespace understory
