// kissfft in double, behind plain vectors.
#include "sim/fourier.hpp"

#include <algorithm>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#include <kissfft/kissfft.hh>
#pragma GCC diagnostic pop

namespace understory {

std::vector<std::complex<double>> half_spectrum(const std::vector<double>& series) {
  const std::vector<std::complex<double>> input(series.begin(), series.end());
  std::vector<std::complex<double>> output(input.size());
  kissfft<double>(input.size(), false).transform(input.data(), output.data());
  output.resize(input.size() / 2 + 1);
  return output;
}

std::vector<double> real_series(const std::vector<std::complex<double>>& spectrum, std::size_t count) {
  std::vector<std::complex<double>> full(count), output(count);
  for (std::size_t k = 0; k < std::min(spectrum.size(), count / 2 + 1); ++k) {
    full[(count - k) % count] = std::conj(spectrum[k]);
    full[k] = spectrum[k];
  }
  kissfft<double>(count, true).transform(full.data(), output.data());
  std::vector<double> series(count);
  std::ranges::transform(output, series.begin(),
                         [count](std::complex<double> value) { return value.real() / static_cast<double>(count); });
  return series;
}

std::size_t fast_length(std::size_t limit) {
  std::size_t best = 1;
  for (std::size_t twos = 1; twos <= limit; twos *= 2) {
    for (std::size_t threes = twos; threes <= limit; threes *= 3) {
      std::size_t fives = threes;
      while (fives <= limit / 5) fives *= 5;
      best = std::max(best, fives);
    }
  }
  return best;
}

}  // namespace understory
