// Synthetic gusts: amplitudes from the spectrum, phases by chance, one inverse transform per component.
// Measured gusts: read, turned into their mean direction, closed to a loop, resampled.
#include "sim/gusts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <vector>

#include "sim/error.hpp"
#include "sim/files/csv.hpp"
#include "sim/fourier.hpp"
#include "sim/random.hpp"

namespace understory {
namespace {

constexpr std::size_t synthetic_count = 1 << 15;
constexpr double synthetic_rate = 32;     // samples per second
constexpr double across_share = 0.8;      // sigma_v / sigma_u
constexpr double slowest_carrier = 1e-3;  // m/s: keeps the densities within range in all but still air
constexpr std::size_t least_record = 64, most_samples = 1 << 20;
constexpr double fastest =
    120;  // m/s; beyond every wind measured near the ground, short of the usual marks for "missing"

// Power densities up to a factor. n = f L / U is the number of integral lengths per wavelength.
double along_density(double n) { return std::pow(1 + 70.8 * n * n, -5.0 / 6.0); }
// Across, eddies are half as long: Burton et al. with L_v = L_u / 2.
double across_density(double n) { return (1 + 188.8 * n * n) * std::pow(1 + 70.8 * n * n, -11.0 / 6.0); }

using Density = double (*)(double);

std::vector<double> synthesise(Density density, double bins_per_length, double deviation, std::uint64_t seed,
                               const char* component) {
  std::vector<std::complex<double>> spectrum(synthetic_count / 2);  // no Nyquist bin
  double power = 0;
  for (std::size_t bin = 1; bin < spectrum.size(); ++bin) {
    const double amplitude = std::sqrt(density(static_cast<double>(bin) * bins_per_length));
    const double phase = 2 * std::numbers::pi * Random(seed, stream_of(component), bin).uniform();
    spectrum[bin] = std::polar(amplitude, phase);
    power += 2 * amplitude * amplitude;
  }
  const double scale = deviation * static_cast<double>(synthetic_count) / std::sqrt(power);
  for (std::complex<double>& value : spectrum) value *= scale;
  return real_series(spectrum, synthetic_count);
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Samples per second, from the first and last of equally spaced times.
double sampling_rate(const CsvTable& table, const std::string& column) {
  const std::vector<double> times = table.times(column);
  const double step = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  for (std::size_t row = 1; row < times.size(); ++row) {
    // Written times are rounded (to the millisecond, say), hence a fifth of a step.
    if (!(step > 0) || std::abs(times[row] - times[row - 1] - step) > 0.2 * step)
      throw Error(
          ErrorKind::invalid_input,
          fmt::format("{}:{}: column '{}': '{}' is {:.6g} s after the line before, allowed: equally spaced times, "
                      "here every {:.6g} s",
                      table.file().string(), table.line(row), column, table.text(column)[row],
                      times[row] - times[row - 1], step));
  }
  return 1 / step;
}

std::vector<double> velocities(const CsvTable& table, const std::string& column) {
  std::vector<double> values = table.numbers(column);
  for (std::size_t row = 0; row < values.size(); ++row) {
    if (std::abs(values[row]) > fastest)
      throw Error(ErrorKind::invalid_input,
                  fmt::format("{}:{}: column '{}': {:.6g} m/s, allowed: -{} to {}", table.file().string(),
                              table.line(row), column, values[row], fastest, fastest));
  }
  return values;
}

/// A series of `length` samples whose end runs on into its start: what lies beyond `length` fades out over the start.
/// Equal power, so that the deviation stays as it is where both sides are independent.
std::vector<double> close_loop(const std::vector<double>& values, std::size_t length) {
  std::vector<double> loop(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(length));
  const std::size_t overlap = values.size() - length;
  for (std::size_t i = 0; i < overlap; ++i) {
    const double angle = std::numbers::pi / 2 * static_cast<double>(i) / static_cast<double>(overlap);
    loop[i] = std::sin(angle) * values[i] + std::cos(angle) * values[length + i];
  }
  return loop;
}

/// The same periodic signal, about its mean, at another number of samples; frequencies that do not fit are left out.
std::vector<double> resample(const std::vector<double>& periodic, std::size_t count) {
  std::vector<std::complex<double>> spectrum = half_spectrum(periodic);
  spectrum[0] = 0;
  // The Nyquist bin of an even length stands for both signs of its frequency.
  if (periodic.size() % 2 == 0) spectrum.back() *= count > periodic.size() ? 0.5 : 1.0;
  if (spectrum.size() > count / 2) spectrum.resize(count / 2);
  for (std::complex<double>& value : spectrum)
    value *= static_cast<double>(count) / static_cast<double>(periodic.size());
  return real_series(spectrum, count);
}

}  // namespace

GustSeries synthetic_gusts(double mean_speed, double deviation, double length_scale, std::uint64_t seed) {
  GustSeries gusts{synthetic_rate, std::vector<double>(synthetic_count), std::vector<double>(synthetic_count)};
  if (!(mean_speed > 0) || !(deviation > 0)) return gusts;
  const double carrier = std::max(mean_speed, slowest_carrier);
  const double bins_per_length = synthetic_rate / static_cast<double>(synthetic_count) * length_scale / carrier;
  gusts.along = synthesise(along_density, bins_per_length, deviation, seed, "gusts along");
  gusts.across = synthesise(across_density, bins_per_length, across_share * deviation, seed, "gusts across");
  return gusts;
}

WindRecord read_wind_record(const std::filesystem::path& file) {
  const CsvTable table(file);
  const char* clock = table.has("timestamp") ? "timestamp" : "time_s";
  if (!table.has(clock))
    throw Error(
        ErrorKind::invalid_input,
        fmt::format("{}:1: no column with the time, allowed: 'timestamp' (date and time) or 'time_s'", file.string()));
  if (table.rows() < least_record)
    throw Error(ErrorKind::invalid_input,
                fmt::format("{}: {} samples of wind, allowed: at least {}", file.string(), table.rows(), least_record));
  std::vector<double> u = velocities(table, "u_ms"), v = velocities(table, "v_ms");
  const double rate = sampling_rate(table, clock);

  const double mean_u = mean_of(u), mean_v = mean_of(v), mean_speed = std::hypot(mean_u, mean_v);
  const double x = mean_speed > 0 ? mean_u / mean_speed : 1, y = mean_speed > 0 ? mean_v / mean_speed : 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double du = u[i] - mean_u, dv = v[i] - mean_v;
    u[i] = x * du + y * dv;  // along
    v[i] = x * dv - y * du;  // across, to the left
  }

  const std::size_t length = fast_length(u.size() - u.size() / 10);
  const std::size_t count = std::min(std::bit_ceil(length), most_samples);
  WindRecord record;
  record.mean_speed = mean_speed;
  record.gusts.rate = rate * static_cast<double>(count) / static_cast<double>(length);
  record.gusts.along = resample(close_loop(u, length), count);
  record.gusts.across = resample(close_loop(v, length), count);
  return record;
}

}  // namespace understory
