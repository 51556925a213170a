// Profile, source of gusts, and the oscillators that answer them: filtered once in frequency, looked up for ever after.
#include "sim/wind.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "sim/error.hpp"
#include "sim/fourier.hpp"
#include "sim/gusts.hpp"

namespace understory {
namespace {

constexpr double von_karman_constant = 0.4;
constexpr double slowest_convection = 0.5;  // m/s: bounds the delay between two places in still air
constexpr double least_damping = 0.01;      // ratio to critical; keeps the peak of H below 50
constexpr double deflection_speed = 10;     // m/s, at which SwayMode::deflection is stated

void require(bool holds, const char* key, double value, const std::string& allowed) {
  if (!holds) throw Error(ErrorKind::invalid_input, fmt::format("wind.{}: {:.6g}, allowed: {}", key, value, allowed));
}

void check(const WindSource& source) {
  require(source.length_scale >= 0.1 && source.length_scale <= 1e5, "length_scale", source.length_scale,
          "0.1 to 1e5 m");
  require(source.roughness_length > 0, "roughness_length", source.roughness_length, "above 0 m");
  require(source.displacement_height >= 0, "displacement_height", source.displacement_height, "0 m or more");
  const double least = source.displacement_height + source.roughness_length;
  const std::string above = fmt::format("above displacement_height + roughness_length = {:.6g} m", least);
  if (!source.record.empty()) {
    require(source.record_height > least, "record_height", source.record_height, above);
    return;
  }
  require(source.reference_height > least, "reference_height", source.reference_height, above);
  require(source.speed >= 0 && source.speed <= 200, "speed", source.speed, "0 to 200 m/s");
  require(source.turbulence_intensity >= 0 && source.turbulence_intensity <= 10, "turbulence_intensity",
          source.turbulence_intensity, "0 to 10");
}

/// A steady or varying tip angle per unit of force, radians at flexibility 1, as a series through H(f).
std::vector<double> oscillate(const std::vector<double>& force, double rate, const SwayMode& mode) {
  std::vector<std::complex<double>> spectrum = half_spectrum(force);
  const double damping = std::max(mode.damping, least_damping);
  for (std::size_t bin = 0; bin < spectrum.size(); ++bin) {
    const double ratio = static_cast<double>(bin) * rate / static_cast<double>(force.size()) / mode.frequency;
    spectrum[bin] /= std::complex<double>(1 - ratio * ratio, 2 * damping * ratio);
  }
  return real_series(spectrum, force.size());
}

/// Length below `largest_tip_angle`, direction kept, slope 1 at zero.
glm::dvec2 saturate(glm::dvec2 angle) {
  const double size = std::hypot(angle.x, angle.y);
  return size > 0 ? angle * (largest_tip_angle * std::tanh(size / largest_tip_angle) / size) : angle;
}

}  // namespace

Wind::Wind(const WindSource& source, std::uint64_t seed)
    : direction_(std::cos(source.direction), std::sin(source.direction)),
      length_scale_(source.length_scale),
      roughness_length_(source.roughness_length),
      displacement_height_(source.displacement_height) {
  check(source);
  double speed = source.speed, height = source.reference_height;
  if (source.record.empty()) {
    gusts_ = synthetic_gusts(speed, source.turbulence_intensity * speed, source.length_scale, seed);
  } else {
    WindRecord record = read_wind_record(source.record);
    speed = record.mean_speed;
    height = source.record_height;
    gusts_ = std::move(record.gusts);
  }
  friction_velocity_ = von_karman_constant * speed / std::log((height - displacement_height_) / roughness_length_);
  convection_speed_ = std::max(speed, slowest_convection);
}

double Wind::mean_speed(double height) const {
  const double above = height - displacement_height_;
  if (above <= roughness_length_) return 0;
  return friction_velocity_ / von_karman_constant * std::log(above / roughness_length_);
}

ModalSeries Wind::respond(const SwayMode& mode, double height) const {
  if (!(mode.frequency > 0))
    throw Error(ErrorKind::invalid_input, fmt::format("sway frequency: {:.6g} Hz, allowed: above 0", mode.frequency));
  const double speed = mean_speed(height), per_square = mode.deflection / (deflection_speed * deflection_speed);
  std::vector<double> along = gusts_.along, across = gusts_.across;
  for (double& value : along) value *= 2 * speed * per_square;
  for (double& value : across) value *= speed * per_square;
  along = oscillate(along, gusts_.rate, mode);
  across = oscillate(across, gusts_.rate, mode);

  ModalSeries series;
  series.rate = gusts_.rate;
  const double steady = speed * speed * per_square;
  series.mean = saturate({steady, 0}).x;
  series.along.reserve(along.size());
  series.across.reserve(along.size());
  for (std::size_t i = 0; i < along.size(); ++i) {
    const glm::dvec2 angle = saturate({steady + along[i], across[i]});
    series.along.push_back(static_cast<float>(angle.x - series.mean));
    series.across.push_back(static_cast<float>(angle.y));
  }
  return series;
}

glm::dvec2 ModalSeries::at(double time) const {
  if (along.empty()) return {mean, 0};
  const double count = static_cast<double>(along.size());
  const double sample = time * rate - std::floor(time * rate / count) * count;
  const std::size_t mask = along.size() - 1;
  const std::size_t first = static_cast<std::size_t>(sample) & mask, second = (first + 1) & mask;
  const double share = sample - std::floor(sample);
  return {mean + std::lerp(static_cast<double>(along[first]), static_cast<double>(along[second]), share),
          std::lerp(static_cast<double>(across[first]), static_cast<double>(across[second]), share)};
}

}  // namespace understory
