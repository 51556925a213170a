// Where rays go: the sequence is stratified, its replicates are independent, the maps have the densities they claim.
#include "host/trace/directions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sim/random.hpp"

namespace understory {
namespace {

/// Each of the 2^k rectangles 2^-a wide and 2^-(k-a) high holds one of the 2^k points: a (0, k, 2)-net.
bool is_net(const std::vector<glm::vec2>& points, int k, int a) {
  std::vector<int> hits(points.size(), 0);
  for (const glm::vec2 u : points) {
    const auto column = static_cast<std::size_t>(u.x * static_cast<float>(1 << a));
    const auto row = static_cast<std::size_t>(u.y * static_cast<float>(1 << (k - a)));
    ++hits.at((column << (k - a)) + row);
  }
  return std::all_of(hits.begin(), hits.end(), [](int count) { return count == 1; });
}

TEST(ScrambledSobol, EveryAlignedRunIsANet) {
  for (const std::uint32_t seed : {0u, 1u, 12345u, 0xffffffffu})
    for (int k = 0; k <= 9; ++k)
      for (const std::uint32_t run : {0u, 1u, 6u}) {
        std::vector<glm::vec2> points;
        for (std::uint32_t i = 0; i < 1u << k; ++i) points.push_back(scrambled_sobol((run << k) + i, seed));
        for (int a = 0; a <= k; ++a) ASSERT_TRUE(is_net(points, k, a)) << "seed " << seed << ", 2^" << k << ", " << a;
      }
}

TEST(ScrambledSobol, OnePointIsUniformOverSeeds) {
  for (const std::uint32_t index : {0u, 5u}) {
    std::vector<int> cells(64, 0);
    double sum = 0;
    constexpr int seeds = 64 * 256;
    for (std::uint32_t seed = 0; seed < seeds; ++seed) {
      const glm::vec2 u = scrambled_sobol(index, seed);
      ASSERT_TRUE(u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1);
      ++cells.at(static_cast<std::size_t>(u.x * 8) * 8 + static_cast<std::size_t>(u.y * 8));
      sum += (u.x - 0.5) * (u.y - 0.5);
    }
    double chi_squared = 0;
    for (const int count : cells) chi_squared += (count - 256.0) * (count - 256.0) / 256;
    EXPECT_LT(chi_squared, 120) << "63 degrees of freedom: beyond 103 once in a thousand";
    EXPECT_LT(std::abs(sum / seeds), 4.0 / 12 / std::sqrt(seeds)) << "both coordinates are independent";
  }
}

struct Moments {
  double z = 0, z_squared = 0;
  glm::dvec3 mean{0};
};

template <typename Map>
Moments moments(Map map) {
  constexpr std::uint32_t count = 1u << 14;
  Moments sum;
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::dvec3 d(map(scrambled_sobol(i, 77)));
    EXPECT_NEAR(glm::length(d), 1, 2e-6);
    sum.mean += d / double(count);
    sum.z += d.z / count;
    sum.z_squared += d.z * d.z / count;
  }
  EXPECT_NEAR(sum.mean.x, 0, 1e-4);
  EXPECT_NEAR(sum.mean.y, 0, 1e-4);
  return sum;
}

TEST(Maps, HaveTheMomentsOfTheirDensity) {
  const Moments sphere = moments(uniform_sphere), cosine = moments(cosine_hemisphere),
                hemisphere = moments(uniform_hemisphere);
  EXPECT_NEAR(sphere.z, 0, 1e-4);
  EXPECT_NEAR(sphere.z_squared, 1.0 / 3, 1e-4);
  EXPECT_NEAR(cosine.z, 2.0 / 3, 1e-4);
  EXPECT_NEAR(cosine.z_squared, 0.5, 1e-4);
  EXPECT_NEAR(hemisphere.z, 0.5, 1e-4);
  EXPECT_NEAR(hemisphere.z_squared, 1.0 / 3, 1e-4);
}

TEST(Frame, IsRightHandedAboutAnyNormal) {
  std::vector<glm::vec3> normals = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}, {0.6f, 0.8f, -0.0f}};
  for (std::uint64_t i = 0; i < 1000; ++i) {
    Random random(3, stream_of("normals"), i);
    normals.push_back(uniform_sphere({float(random.uniform()), float(random.uniform())}));
  }
  for (const glm::vec3 n : normals) {
    const glm::mat3 m = frame_about(n);
    EXPECT_EQ(m[2], n);
    EXPECT_NEAR(glm::determinant(m), 1, 1e-5);
    const glm::mat3 unit = glm::transpose(m) * m;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) EXPECT_NEAR(unit[i][j], i == j ? 1 : 0, 1e-5);
  }
}

}  // namespace
}  // namespace understory
