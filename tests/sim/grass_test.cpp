// Grass: statistics as asked, bare places bare, clumps where asked for, and the mean light below it.
#include "sim/grass.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/support/errors.hpp"

namespace understory {
namespace {

const GroundHeight level = [](glm::dvec2) { return std::optional<double>(0.5); };

GrassField meadow() {
  GrassField field;
  field.region = {{-3, 4}, {10, 11}};
  field.density = 200;
  return field;
}

double mean_of(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

/// Variance of the number of blades in squares of 20 cm over its mean: 1 for independent blades.
double dispersion(const GrassBlades& blades) {
  std::vector<double> count(65 * 35, 0);
  for (std::size_t i = 0; i < blades.size(); ++i)
    count[std::size_t((blades.root_y[i] - 4) / 0.2f) * 65 + std::size_t((blades.root_x[i] + 3) / 0.2f)] += 1;
  const double mean = double(blades.size()) / double(count.size());
  double variance = 0;
  for (double n : count) variance += (n - mean) * (n - mean) / double(count.size());
  return variance / mean;
}

TEST(Grass, HasTheDensityAndStatisticsAskedFor) {
  const GrassField field = meadow();
  const GrassBlades blades = grow_grass(field, 0, 1, level, {});
  ASSERT_EQ(blades.size(), 18'200u);
  // Four standard errors of the mean.
  const double root = std::sqrt(18'200.0);
  EXPECT_NEAR(mean_of(blades.length), 0.35, 4 * 0.08 / root);
  EXPECT_NEAR(mean_of(blades.half_width), 0.003, 4 * 0.0005 / root);
  EXPECT_NEAR(mean_of(blades.root_x), 3.5, 4 * 13 / std::sqrt(12.0) / root);
  EXPECT_NEAR(mean_of(blades.bend_x), 0, 4 * 0.4 / root);
  for (std::size_t i = 0; i < blades.size(); ++i) {
    EXPECT_TRUE(field.region.contains({blades.root_x[i], blades.root_y[i]}));
    EXPECT_EQ(blades.root_z[i], 0.5f);
    EXPECT_GT(blades.length[i], 0);
    EXPECT_GT(blades.flexibility[i], 0);
  }
}

TEST(Grass, RefusesMoreBladesThanAnyDeviceHolds) {
  GrassField field = meadow();
  field.region = {{0, 0}, {1e4, 1e4}};
  field.density = 1e4;
  const std::string message = message_of(ErrorKind::invalid_input, [&] { grow_grass(field, 2, 1, level, {}); });
  EXPECT_THAT(message, testing::HasSubstr("grass.2"));
  EXPECT_THAT(message, testing::HasSubstr("1e+12"));
}

TEST(Grass, NeighboursInTheListAreNeighboursInTheField) {
  const GrassBlades blades = grow_grass(meadow(), 0, 1, level, {});
  double widest_sum = 0;
  int runs = 0;
  for (std::size_t first = 0; first + 51 <= blades.size(); first += 51, ++runs) {
    const auto [low, high] = std::minmax_element(&blades.root_x[first], &blades.root_x[first] + 51);
    widest_sum += *high - *low;
  }
  EXPECT_LT(widest_sum / runs, 1.2);  // 51 blades cover half a metre; a run may straddle two tiles
}

TEST(Grass, IsTheSameEveryTimeAndOtherwiseForAnotherSeed) {
  const GrassBlades first = grow_grass(meadow(), 2, 1, level, {}), again = grow_grass(meadow(), 2, 1, level, {});
  EXPECT_EQ(first.root_x, again.root_x);
  EXPECT_EQ(first.bend_y, again.bend_y);
  EXPECT_EQ(first.phase, again.phase);
  EXPECT_NE(first.root_x, grow_grass(meadow(), 2, 7, level, {}).root_x);
  EXPECT_NE(first.root_x, grow_grass(meadow(), 3, 1, level, {}).root_x);
}

TEST(Grass, ClumpingGathersBladesWithoutLosingAny) {
  GrassField field = meadow();
  const double even = dispersion(grow_grass(field, 0, 1, level, {}));
  field.clumping = 0.9;
  const GrassBlades tufts = grow_grass(field, 0, 1, level, {});
  EXPECT_EQ(tufts.size(), 18'200u);
  EXPECT_LT(even, 1.2);
  EXPECT_GT(dispersion(tufts), 3);
}

TEST(Grass, KeepsOffTrunksAndOffHoles) {
  const std::vector<Disc> trunks{{{0, 6}, 0.7}, {{9.9, 10.9}, 1.5}, {{-40, 0}, 2}};
  const GroundHeight holed = [](glm::dvec2 p) { return p.x > 3 && p.x < 4 ? std::nullopt : std::optional<double>(0); };
  const GrassBlades blades = grow_grass(meadow(), 0, 1, holed, trunks);
  for (std::size_t i = 0; i < blades.size(); ++i) {
    const glm::dvec2 root{blades.root_x[i], blades.root_y[i]};
    for (const Disc& trunk : trunks) EXPECT_GE(glm::distance(root, trunk.centre), trunk.radius - 1e-5);
    EXPECT_FALSE(root.x > 3.0001 && root.x < 3.9999);
  }
  EXPECT_NEAR(double(blades.size()), 200 * (91 - 7 - std::acos(-1.0) * 0.49 - 2.1), 150);
}

TEST(Grass, WithoutGroundItIsAnError) {
  EXPECT_THAT(message_of(ErrorKind::invalid_input,
                         [] { grow_grass(meadow(), 4, 1, [](glm::dvec2) { return std::optional<double>(); }, {}); }),
              testing::HasSubstr("grass.4.region"));
}

TEST(ExponentialIntegral, GivesTheTruthsOfALayerOfLeaves) {
  // 2 E_3(LAI / 2): FORMULAS.md, analytic truths, to the digits given there.
  const std::vector<std::array<double, 3>> truths{
      {0.5, 0.649368, 5e-7}, {1, 0.443209, 5e-7}, {2, 0.219384, 5e-7},   {3, 0.113479, 5e-7},   {4, 0.060267, 5e-7},
      {5, 0.032591, 5e-7},   {6, 0.017861, 5e-7}, {10, 1.7556e-3, 5e-8}, {20, 7.098e-6, 5e-10}, {50, 9.96e-13, 5e-16}};
  for (const auto& [lai, visibility, digit] : truths)
    EXPECT_NEAR(2 * exponential_integral_3(lai / 2), visibility, digit) << "LAI " << lai;
  EXPECT_EQ(exponential_integral_3(0), 0.5);
  EXPECT_GE(exponential_integral_3(1e4), 0);
}

TEST(ExponentialIntegral, AgreesWithItsContinuedFraction) {
  // Lentz's method on E_n(x) = exp(-x) / (x + n - 1 n / (x + n + 2 - 2 (n + 1) / ...)): an independent second form.
  const auto continued_fraction = [](double x) {
    double b = x + 3, c = 1e300, d = 1 / b, h = d;
    for (int i = 1; i < 10'000; ++i) {
      const double a = -i * (2.0 + i);
      b += 2;
      d = 1 / (a * d + b);
      c = b + a / c;
      h *= c * d;
      if (std::abs(c * d - 1) < 1e-16) break;
    }
    return h * std::exp(-x);
  };
  for (double x = 0.05; x < 100; x *= 1.07)
    EXPECT_NEAR(exponential_integral_3(x) / continued_fraction(x), 1, 1e-10) << x;
  EXPECT_NEAR(exponential_integral_3(101), continued_fraction(101), 1e-45);
}

TEST(GroundCover, FollowsTheBladesAreaAndIsBareOutside) {
  GrassField field = meadow();
  field.density = 2000;
  field.height = {0.5, 0};
  field.width = {0.004, 0};
  const GroundCover cover = cover_ground({grow_grass(field, 0, 1, level, {})});
  const double lai = 2000 * 0.5 * 0.004 * blade_fullness;
  const double expected = 2 * exponential_integral_3(lai / 2);
  ASSERT_EQ(cover.visibility.size(), std::size_t(cover.columns) * cover.rows);
  double inner = 0;
  int cells = 0;
  for (std::uint32_t row = 0; row < cover.rows; ++row)
    for (std::uint32_t column = 0; column < cover.columns; ++column) {
      const float v = cover.visibility[row * cover.columns + column];
      if (row == 0 || column == 0 || row + 1 == cover.rows || column + 1 == cover.columns) {
        EXPECT_EQ(v, 1);
      } else if (row > 1 && column > 1 && row + 2 < cover.rows && column + 2 < cover.columns) {
        inner += v;
        ++cells;
      }
    }
  EXPECT_NEAR(inner / cells, expected, 0.01);
  EXPECT_TRUE(cover.extent.contains({-3, 4}) && cover.extent.contains({10, 11}));
}

TEST(GroundCover, BladeFullnessIsTheAreaOfItsFiveTriangles) {
  // Vertices in the plane: pairs at +- width, tip at (1, 0).
  glm::dvec2 vertex[7];
  for (int pair = 0; pair < 3; ++pair)
    for (int side = 0; side < 2; ++side)
      vertex[2 * pair + side] = {blade_pair_place[pair], (side ? -1 : 1) * blade_pair_width[pair]};
  vertex[6] = {1, 0};
  double area = 0;
  for (int k = 0; k < 5; ++k) {
    const glm::dvec2 a = vertex[k + 1] - vertex[k], b = vertex[k + 2] - vertex[k];
    area += std::abs(a.x * b.y - a.y * b.x) / 2;
  }
  EXPECT_NEAR(blade_fullness, area / 2, 1e-12);
}

TEST(GroundCover, WithoutBladesThereIsNoGrid) { EXPECT_EQ(cover_ground({}).columns, 0u); }

}  // namespace
}  // namespace understory
