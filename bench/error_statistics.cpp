#include "bench/error_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "host/trace/truth.hpp"
#include "sim/error.hpp"

namespace understory {
namespace {

void require_same_size(std::size_t size, std::size_t expected, const char* what) {
  if (size != expected)
    throw Error(ErrorKind::unexpected, "error statistics: " + std::to_string(size) + " " + what + " for " +
                                           std::to_string(expected) + " values");
}

double log_of(float visibility) { return std::log(std::max<double>(visibility, log_floor)); }

/// Mean variance of the truth and the share of values in its intervals.
void add_truth(std::span<const float> value, std::span<const float> reference, std::span<const float> halfwidth,
               std::span<const std::uint32_t> rays, ErrorStatistics& result) {
  double variance = 0;
  std::size_t inside = 0;
  for (std::size_t i = 0; i < value.size(); ++i) {
    variance += truth_variance(halfwidth[i], rays[i]);
    inside += std::abs(value[i] - reference[i]) <= halfwidth[i];
  }
  const auto count = static_cast<double>(value.size());
  result.truth_noise = std::sqrt(variance / count);
  result.inside = static_cast<double>(inside) / count;
}

}  // namespace

ErrorStatistics error_statistics(std::span<const float> value, std::span<const float> reference,
                                 std::span<const float> halfwidth, std::span<const std::uint32_t> rays) {
  ErrorStatistics result;
  result.pixels = value.size();
  require_same_size(reference.size(), value.size(), "reference values");
  if (!halfwidth.empty()) require_same_size(halfwidth.size(), value.size(), "half-widths");
  require_same_size(rays.size(), halfwidth.size(), "ray counts");
  if (value.empty()) return result;
  const auto count = static_cast<double>(value.size());
  std::vector<double> absolute;
  double squares = 0, reference_squares = 0;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const double error = double(value[i]) - reference[i];
    absolute.push_back(std::abs(error));
    squares += error * error / count;
    result.bias += error / count;
    result.mae += std::abs(error) / count;
    result.log_mae += std::abs(log_of(value[i]) - log_of(reference[i])) / count;
    result.reference_mean += reference[i] / count;
  }
  for (const float r : reference)
    reference_squares += (r - result.reference_mean) * (r - result.reference_mean) / count;
  std::sort(absolute.begin(), absolute.end());
  result.max = absolute.back();
  result.p95 = absolute[static_cast<std::size_t>(std::ceil(0.95 * count)) - 1];
  result.rmse = std::sqrt(squares);
  if (!halfwidth.empty()) add_truth(value, reference, halfwidth, rays, result);
  const double noise = result.truth_noise * result.truth_noise;
  result.rmse_denoised = std::sqrt(std::max(squares - noise, 0.0));
  result.best_constant = std::sqrt(std::max(reference_squares - noise, 0.0));
  return result;
}

}  // namespace understory
