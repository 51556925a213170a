#include "bench/ssim.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include "sim/error.hpp"

namespace understory {
namespace {

constexpr int reach = 5;
constexpr double deviation = 1.5;
constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;

using Values = std::vector<double>;

/// One direction of the separable window, of `count` values `step` apart from `first`.
void smooth_line(const Values& from, Values& to, std::size_t first, std::size_t step, int count) {
  std::array<double, reach + 1> weight{};
  for (int k = 0; k <= reach; ++k)
    weight[static_cast<std::size_t>(k)] = std::exp(-0.5 * k * k / (deviation * deviation));
  for (int i = 0; i < count; ++i) {
    double sum = 0, weights = 0;
    for (int k = std::max(i - reach, 0); k <= std::min(i + reach, count - 1); ++k) {
      const double w = weight[static_cast<std::size_t>(std::abs(k - i))];
      sum += w * from[first + step * static_cast<std::size_t>(k)];
      weights += w;
    }
    to[first + step * static_cast<std::size_t>(i)] = sum / weights;
  }
}

Values smooth(int width, int height, const Values& image) {
  const auto columns = static_cast<std::size_t>(width);
  Values rows(image.size()), both(image.size());
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) smooth_line(image, rows, y * columns, 1, width);
  for (std::size_t x = 0; x < columns; ++x) smooth_line(rows, both, x, columns, height);
  return both;
}

Values products(std::span<const float> a, std::span<const float> b) {
  Values result(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) result[i] = double(a[i]) * b[i];
  return result;
}

}  // namespace

std::vector<float> ssim_map(int width, int height, std::span<const float> a, std::span<const float> b) {
  const std::size_t size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (a.size() != size || b.size() != size)
    throw Error(ErrorKind::unexpected, "SSIM: " + std::to_string(a.size()) + " and " + std::to_string(b.size()) +
                                           " values for " + std::to_string(size) + " pixels");
  const auto mean = [&](const Values& image) { return smooth(width, height, image); };
  const Values mean_a = mean(Values(a.begin(), a.end())), mean_b = mean(Values(b.begin(), b.end()));
  const Values aa = mean(products(a, a)), bb = mean(products(b, b)), ab = mean(products(a, b));
  std::vector<float> index(size);
  for (std::size_t i = 0; i < size; ++i) {
    const double ma = mean_a[i], mb = mean_b[i];
    const double variances = std::max(aa[i] - ma * ma, 0.0) + std::max(bb[i] - mb * mb, 0.0);
    const double covariance = ab[i] - ma * mb;
    index[i] =
        static_cast<float>((2 * ma * mb + c1) * (2 * covariance + c2) / ((ma * ma + mb * mb + c1) * (variances + c2)));
  }
  return index;
}

}  // namespace understory
