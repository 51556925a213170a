// Ground under an endless random canopy of spherical leaf angles: V_c = 2 E3(LAI/2) on average (FORMULAS.md). Exact for
// leaves of any size when they are strewn independently: a ray meets a Poisson number of them.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "host/trace/truth.hpp"
#include "sim/random.hpp"
#include "tests/support/triangles.hpp"

namespace understory {
namespace {

constexpr double half_width = 7;   // m of canopy on either side of the points, 1 m thick: 8 degrees above the horizon
constexpr float leaf_edge = 0.1f;  // m

Triangles canopy(double leaf_area_index, std::uint64_t realisation) {
  Triangles leaves;
  const double area = 4 * half_width * half_width;
  const auto count = static_cast<std::uint64_t>(leaf_area_index * area / (leaf_edge * leaf_edge));
  for (std::uint64_t i = 0; i < count; ++i) {
    Random random(realisation, stream_of("canopy"), i);
    const auto u = [&](double low, double high) { return static_cast<float>(random.uniform(low, high)); };
    const glm::vec3 centre(u(-half_width, half_width), u(-half_width, half_width), u(0.1, 1.1));
    add_square(leaves, centre, uniform_sphere({u(0, 1), u(0, 1)}), leaf_edge);
  }
  return leaves;
}

TEST(CanopyTruth, MeetsTheExponentialIntegral) {
  const double expected[][2] = {{0.5, 0.649368}, {1, 0.443209}, {2, 0.219384}, {3, 0.113479}, {6, 0.017861}};
  for (const auto& [leaf_area_index, visibility] : expected) {
    constexpr int realisations = 5;
    double means[realisations], mean = 0, squares = 0;
    for (int r = 0; r < realisations; ++r) {
      const Triangles leaves = canopy(leaf_area_index, static_cast<std::uint64_t>(r));
      const Tracer tracer(leaves.vertices, leaves.triangles);
      std::vector<glm::vec3> positions;
      for (int i = 0; i < 64; ++i) positions.emplace_back((i % 8 - 3.5) * 0.25, (i / 8 - 3.5) * 0.25, 0);
      const std::vector<glm::vec3> normals(positions.size(), glm::vec3(0, 0, 1));
      const Truth truth = trace_truth(tracer, positions, normals, {.rays = 256});
      means[r] = 0;
      for (const float v : truth.visibility) means[r] += v / 64;
      mean += means[r] / realisations;
    }
    for (const double m : means) squares += (m - mean) * (m - mean);
    const double standard_error = std::sqrt(squares / (realisations * (realisations - 1)));
    const double error = std::abs(mean - visibility);
    EXPECT_TRUE(error <= 0.02 * visibility || error <= 3 * standard_error)
        << "LAI " << leaf_area_index << ": " << mean << " +- " << standard_error << ", not " << visibility;
    EXPECT_LT(standard_error, 0.05 * visibility + 0.002) << "LAI " << leaf_area_index << ": too noisy to tell";
    RecordProperty("LAI " + std::to_string(leaf_area_index), std::to_string(mean));
    std::printf("LAI %.1f: %.6f +- %.6f, closed form %.6f\n", leaf_area_index, mean, standard_error, visibility);
  }
}

}  // namespace
}  // namespace understory
