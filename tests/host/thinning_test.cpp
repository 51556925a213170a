// Thinning: a group keeps its area at every share, and nothing appears or leaves at once.
#include "host/frame/thinning.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/frame/spread_order.hpp"
#include "sim/random.hpp"

namespace understory {
namespace {

std::vector<float> thinned(std::size_t units, double share) {
  std::vector<float> factors(3, 7.0f);  // of an earlier group
  thin(units, share, factors);
  return factors;
}

TEST(Thinning, KeepsTheAreaOfAGroup) {
  for (std::size_t units : {1u, 2u, 16u, 97u})
    for (double share : {1e-7, 0.01, 0.3, 0.999, 1.0, 1.2, 50.0}) {
      const std::vector<float> factors = thinned(units, share);
      ASSERT_FALSE(factors.empty()) << "a group never disappears";
      const double sum = std::accumulate(factors.begin(), factors.end(), 0.0);
      EXPECT_NEAR(sum, static_cast<double>(units), 1e-5 * static_cast<double>(units)) << share;
      for (std::size_t i = 1; i < factors.size(); ++i) EXPECT_LE(factors[i], factors[i - 1]) << "the last go first";
    }
}

TEST(Thinning, LeavesAGroupAloneThatIsNearEnough) {
  EXPECT_EQ(thinned(16, 1 / (1 - fading_share)), std::vector<float>(16, 1.0f));
  EXPECT_EQ(thinned(1, 2), std::vector<float>(1, 1.0f));
}

TEST(Thinning, DrawsTheShareThatIsAskedFor) {
  for (double share : {0.1, 0.4, 0.9}) EXPECT_NEAR(static_cast<double>(thinned(1000, share).size()), 1000 * share, 1);
}

TEST(SpreadOrder, HoldsEachPointOnceAndSpreadsEveryFirstPart) {
  constexpr std::size_t count = 1000;
  std::vector<glm::vec3> points;
  Random random(4, 2);
  for (std::size_t i = 0; i < count; ++i) points.emplace_back(random.uniform(), random.uniform(), 0.0);
  const std::vector<std::size_t> order = spread_order(points, 7);
  std::vector<std::size_t> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(sorted[i], i);
  // Of the first 64, by chance 16 with a deviation of 3.5 would stand in a quarter of the square, 4 in a sixteenth.
  for (const int cells : {2, 4}) {
    std::vector<int> inside(static_cast<std::size_t>(cells * cells), 0), all = inside;
    for (std::size_t k = 0; k < count; ++k) {
      const glm::ivec2 cell = glm::min(glm::ivec2(glm::vec2(points[order[k]]) * float(cells)), cells - 1);
      const auto at = static_cast<std::size_t>(cell.y * cells + cell.x);
      inside[at] += k < 64;
      ++all[at];
    }
    for (std::size_t at = 0; at < inside.size(); ++at) EXPECT_NEAR(inside[at], 64.0 * all[at] / count, 2) << cells;
  }
}

TEST(SpreadOrder, TakesPointsThatCoincideAndNone) {
  EXPECT_TRUE(spread_order({}, 1).empty());
  EXPECT_EQ(spread_order(std::vector<glm::vec3>(5, glm::vec3(2)), 1).size(), 5u);
}

TEST(Thinning, ChangesWithoutJumps) {
  // Between shares that differ by a ten-thousandth no unit changes by more than a hundredth of the largest.
  for (std::size_t units : {1u, 5u, 40u}) {
    std::vector<float> before = thinned(units, 0.05);
    for (double share = 0.0501; share < 1.6; share += 1e-4) {
      const std::vector<float> now = thinned(units, share);
      for (std::size_t i = 0; i < units; ++i) {
        const float then = i < before.size() ? before[i] : 0.0f, current = i < now.size() ? now[i] : 0.0f;
        ASSERT_NEAR(then, current, 0.01 * static_cast<double>(before.front())) << units << " units at " << share;
      }
      before = now;
    }
  }
}

}  // namespace
}  // namespace understory
