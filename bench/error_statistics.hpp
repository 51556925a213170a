// How far one set of visibilities is from another, the truth's own noise taken into account.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace understory {

/// Logarithms see nothing below this: a dense crown's V of 0.01 counts, the difference between 1e-5 and 0 does not.
inline constexpr double log_floor = 1e-3;

struct ErrorStatistics {
  std::size_t pixels = 0;
  double rmse = 0, mae = 0, bias = 0, max = 0, p95 = 0;  // of value - reference; p95: 95 % of |error| are not above it
  double rmse_denoised = 0;  // the root of the mean square error less the truth's mean variance, at least 0
  double log_mae = 0;        // mean |ln max(value, log_floor) - ln max(reference, log_floor)|
  double inside = -1;        // share of values within the truth's 95 % interval; -1: no truth
  double truth_noise = 0;    // root mean square standard error of the truth; 0: no truth
  double best_constant = 0;  // RMSE of the constant that fits the reference best, denoised
  double reference_mean = 0;
};

/// One entry a pixel, all spans of one size. `halfwidth` and `rays` as truth files hold them, of the reference; empty
/// when it is no truth. Throws Error(unexpected) for sizes that differ. No pixels: all 0.
ErrorStatistics error_statistics(std::span<const float> value, std::span<const float> reference,
                                 std::span<const float> halfwidth, std::span<const std::uint32_t> rays);

}  // namespace understory
