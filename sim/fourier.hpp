// Discrete Fourier transforms of real periodic series, in double.
#pragma once
#include <complex>
#include <cstddef>
#include <vector>

namespace understory {

/// Spectrum X[k] = sum over n of x[n] exp(-2 pi i k n / N), for k = 0 .. N/2; N = series.size() >= 1.
/// Time grows with the largest prime factor of N.
std::vector<std::complex<double>> half_spectrum(const std::vector<double>& series);

/// The real series of `count` samples with that half spectrum, 1/N included: undoes half_spectrum. A spectrum that is
/// too short counts as zero beyond its end, one that is too long is cut off at count/2.
std::vector<double> real_series(const std::vector<std::complex<double>>& spectrum, std::size_t count);

/// Largest number <= `limit` with no prime factor above 5: a fast length. `limit` >= 1.
std::size_t fast_length(std::size_t limit);

}  // namespace understory
