// Error figures from numbers that can be worked out on paper, and the truth's noise taken out of them.
#include "bench/error_statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bench/place_regression.hpp"
#include "bench/ssim.hpp"
#include "host/trace/truth.hpp"
#include "sim/random.hpp"

namespace understory {
namespace {

TEST(ErrorStatistics, OnPaper) {
  const std::vector<float> value = {0.5f, 0.2f, 0.9f, 0}, reference = {0.4f, 0.5f, 0.9f, 0};
  const ErrorStatistics errors = error_statistics(value, reference, {}, {});
  EXPECT_EQ(errors.pixels, 4u);
  EXPECT_NEAR(errors.rmse, std::sqrt((0.01 + 0.09) / 4), 1e-7);
  EXPECT_NEAR(errors.rmse_denoised, errors.rmse, 1e-12) << "no truth, no noise";
  EXPECT_NEAR(errors.mae, 0.1, 1e-7);
  EXPECT_NEAR(errors.bias, -0.05, 1e-7);
  EXPECT_NEAR(errors.max, 0.3, 1e-7);
  EXPECT_NEAR(errors.p95, 0.3, 1e-7);
  EXPECT_NEAR(errors.log_mae, (std::log(0.5 / 0.4) + std::log(0.5 / 0.2)) / 4, 1e-6) << "0 against 0 is no error";
  EXPECT_NEAR(errors.best_constant, std::sqrt((0.05 * 0.05 * 1 + 0.05 * 0.05 + 0.45 * 0.45 + 0.45 * 0.45) / 4), 1e-6);
  EXPECT_EQ(errors.inside, -1);
}

TEST(ErrorStatistics, LogErrorSeesDenseCrownsAndStopsAtItsFloor) {
  const std::vector<float> value = {0.02f, 1e-5f}, reference = {0.01f, 0};
  const ErrorStatistics errors = error_statistics(value, reference, {}, {});
  EXPECT_NEAR(errors.log_mae, std::log(2.0) / 2, 1e-6);
  EXPECT_LT(errors.rmse, 0.01);
}

TEST(ErrorStatistics, OfNothingIsNothing) { EXPECT_EQ(error_statistics({}, {}, {}, {}).rmse, 0); }

TEST(PlaceRegression, LeavesTheScatterThatNoFunctionOfPlaceFollows) {
  std::vector<glm::dvec2> places;
  std::vector<float> truth;
  constexpr double scatter = 0.07;
  for (std::uint64_t i = 0; i < 3000; ++i) {
    Random random(5, stream_of("place"), i);
    const glm::dvec2 p = places.emplace_back(random.uniform(0, 3), random.uniform(-1, 1));
    truth.push_back(static_cast<float>(0.2 * p.x + 0.3 * std::sin(2 * p.y) + scatter * random.normal()));
  }
  const ErrorStatistics errors = error_statistics(best_of_place(places, truth), truth, {}, {});
  EXPECT_NEAR(errors.rmse, scatter, 0.03 * scatter);  // 3000 points: 1.3 %; the function's curve: less
  EXPECT_NEAR(errors.bias, 0, 0.005);
}

TEST(PlaceRegression, PlanesLeaveNothingAndFewPointsTellNothing) {
  std::vector<glm::dvec2> places;
  std::vector<float> truth;
  for (int i = 0; i < 100; ++i) {
    places.emplace_back(i % 10, i / 10);
    truth.push_back(0.03f * static_cast<float>(i % 10) - 0.02f * static_cast<float>(i / 10));
  }
  EXPECT_NEAR(error_statistics(best_of_place(places, truth), truth, {}, {}).max, 0, 1e-6);
  const std::vector<glm::dvec2> few(5);
  const std::vector<float> values{0, 1, 0, 1, 0};
  EXPECT_EQ(best_of_place(few, values), values);
}

TEST(ErrorStatistics, NinetyFivePercentAreNotAbove) {
  std::vector<float> value(1000), reference(1000, 0);
  for (std::size_t i = 0; i < 1000; ++i) value[i] = static_cast<float>(i + 1) / 1000;
  EXPECT_NEAR(error_statistics(value, reference, {}, {}).p95, 0.95, 1e-6);
}

/// A truth of known noise: bells of deviation `noise` about `exact`, as half-widths of 8 replicates would tell it.
TEST(ErrorStatistics, TakesTheNoiseOfTheTruthOut) {
  constexpr int rays = 256;
  constexpr double noise = 0.03, error = 0.02;
  std::vector<float> value, reference, halfwidth;
  const std::vector<std::uint32_t> ray_counts(40000, rays);
  for (std::uint64_t i = 0; i < ray_counts.size(); ++i) {
    Random random(4, stream_of("noise"), i);
    const double exact = random.uniform(0.3, 0.7);
    double means[truth_replicates], mean = 0;
    for (double& m : means) {
      m = exact + noise * std::sqrt(double(truth_replicates)) * random.normal();
      mean += m / truth_replicates;
    }
    value.push_back(static_cast<float>(exact + (i % 2 ? error : -error)));
    reference.push_back(static_cast<float>(mean));
    halfwidth.push_back(interval_halfwidth(means, rays));
  }
  const ErrorStatistics errors = error_statistics(value, reference, halfwidth, ray_counts);
  EXPECT_NEAR(errors.truth_noise, noise, 0.02 * noise);
  EXPECT_NEAR(errors.rmse, std::hypot(noise, error), 0.02 * noise);
  EXPECT_NEAR(errors.rmse_denoised, error, 0.05 * error);
  EXPECT_NEAR(errors.best_constant, 0.4 / std::sqrt(12.0), 0.002);
  const ErrorStatistics exact = error_statistics(reference, reference, halfwidth, ray_counts);
  EXPECT_EQ(exact.inside, 1);
  EXPECT_EQ(exact.rmse_denoised, 0) << "never below 0";
}

TEST(Ssim, IsOneForEqualImagesAndKnownForConstants) {
  const std::vector<float> a(17 * 9, 0.2f), b(17 * 9, 0.6f);
  for (const float index : ssim_map(17, 9, a, a)) EXPECT_FLOAT_EQ(index, 1);
  const double expected = (2 * 0.2 * 0.6 + 1e-4) / (0.04 + 0.36 + 1e-4);
  for (const float index : ssim_map(17, 9, a, b)) EXPECT_NEAR(index, expected, 1e-6);
}

TEST(Ssim, IsTheSumOverItsWindow) {
  constexpr int width = 23, height = 19;
  std::vector<float> a, b;
  for (std::uint64_t i = 0; i < width * height; ++i) {
    Random random(8, stream_of("ssim"), i);
    a.push_back(static_cast<float>(random.uniform()));
    b.push_back(static_cast<float>(0.7 * a.back() + 0.3 * random.uniform()));
  }
  const std::vector<float> map = ssim_map(width, height, a, b);
  for (const auto& [cx, cy] : {std::pair(11, 9), std::pair(0, 0), std::pair(22, 7)}) {
    double weights = 0, ma = 0, mb = 0, va = 0, vb = 0, cab = 0;
    for (int pass = 0; pass < 2; ++pass) {  // means, then central moments: another way than the one tested
      for (int y = std::max(cy - 5, 0); y <= std::min(cy + 5, height - 1); ++y)
        for (int x = std::max(cx - 5, 0); x <= std::min(cx + 5, width - 1); ++x) {
          const double w = std::exp(-((x - cx) * (x - cx) + (y - cy) * (y - cy)) / (2 * 1.5 * 1.5));
          const double va_ = a[std::size_t(y * width + x)], vb_ = b[std::size_t(y * width + x)];
          if (pass == 0) {
            weights += w, ma += w * va_, mb += w * vb_;
          } else {
            va += w * (va_ - ma) * (va_ - ma), vb += w * (vb_ - mb) * (vb_ - mb), cab += w * (va_ - ma) * (vb_ - mb);
          }
        }
      if (pass == 0) ma /= weights, mb /= weights;
    }
    const double expected =
        (2 * ma * mb + 1e-4) * (2 * cab / weights + 9e-4) / ((ma * ma + mb * mb + 1e-4) * ((va + vb) / weights + 9e-4));
    EXPECT_NEAR(map[std::size_t(cy * width + cx)], expected, 1e-6);
  }
}

}  // namespace
}  // namespace understory
