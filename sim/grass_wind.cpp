// The scale of the waves over grass, and the formula of kernels/shared/grass_bend.h with the C++ library's own sines.
#include "sim/grass_wind.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace understory {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;
constexpr double station_height = 10;      // m
constexpr double scales_per_length = 8;    // lateral scale of the waves as a share of the gusts' integral length
constexpr double front_slope = 0.35;       // how far fronts lean from straight: metres downwind per metre across
constexpr double flutter_share = 0.15;     // of the mean bend
constexpr double largest_flutter = 0.05;   // radians
constexpr double largest_wind_bend = 1.5;  // radians, as in kernels/shared/grass_bend.h

/// `value` modulo `period`, in [0, period).
double wrapped(double value, double period) {
  const double rest = value - std::floor(value / period) * period;
  return rest < period ? rest : 0;
}

/// (along, across) about the mean at a sample number of any size.
glm::dvec2 fluctuation(const ModalSeries& response, double sample) {
  return response.at(sample / response.rate) - glm::dvec2(response.mean, 0);
}

}  // namespace

ModalSeries grass_response(const Wind& wind, const GrassField& field) {
  return wind.respond(field.sway, station_height);
}

GrassWind grass_wind_at(const Wind& wind, const GrassField& field, const ModalSeries& response, double time,
                        glm::dvec3 eye) {
  const double slowness = 1 / wind.convection_speed();
  const double lateral_scale = wind.length_scale() / scales_per_length;
  GrassWind record{};
  record.direction_x = static_cast<float>(wind.direction().x);
  record.direction_y = static_cast<float>(wind.direction().y);
  record.slowness = static_cast<float>(slowness);
  record.sample_time = static_cast<float>(wrapped(time * response.rate, static_cast<double>(response.along.size())));
  record.series_rate = static_cast<float>(response.rate);
  record.mean_bend = static_cast<float>(response.mean);
  record.flutter_amplitude = static_cast<float>(std::min(flutter_share * response.mean, largest_flutter));
  record.flutter_phase = static_cast<float>(wrapped(two_pi * field.sway.frequency * time, two_pi));
  record.lateral_scale = static_cast<float>(lateral_scale);
  record.lateral_delay = static_cast<float>(front_slope * lateral_scale * slowness);
  record.root_offset_x = static_cast<float>(-eye.x);
  record.root_offset_y = static_cast<float>(-eye.y);
  record.root_offset_z = static_cast<float>(-eye.z);
  record.series_count = static_cast<record_uint>(response.along.size());
  return record;
}

std::vector<glm::vec2> interleaved(const ModalSeries& response) {
  std::vector<glm::vec2> pairs(response.along.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i] = {response.along[i], response.across[i]};
  return pairs;
}

glm::dvec2 grass_bend(const GrassWind& wind, const ModalSeries& response, const BladeRoot& blade) {
  const glm::dvec2 downwind(wind.direction_x, wind.direction_y), left(-downwind.y, downwind.x);
  const double a = glm::dot(blade.position, downwind) / wind.lateral_scale;
  const double c = glm::dot(blade.position, left) / wind.lateral_scale;
  const double delay = wind.lateral_delay * (std::sin(c + 0.3 * a) + 0.5 * std::sin(1.7 * c - 0.25 * a + 1.3));
  const double sample =
      wind.sample_time - wind.series_rate * (wind.slowness * glm::dot(blade.position, downwind) + delay);
  const glm::dvec2 gust = std::cos(0.5 * c) * fluctuation(response, sample) +
                          std::sin(0.5 * c) * fluctuation(response, sample + 0.5 * wind.series_count);
  const glm::dvec2 flutter =
      static_cast<double>(wind.flutter_amplitude) *
      glm::dvec2(std::sin(wind.flutter_phase + blade.phase), std::sin(wind.flutter_phase + 3 * blade.phase));
  const glm::dvec2 angle = blade.flexibility * (glm::dvec2(wind.mean_bend, 0) + gust + flutter);
  const glm::dvec2 limited = angle / std::sqrt(1 + glm::dot(angle, angle) / (largest_wind_bend * largest_wind_bend));
  return blade.rest_bend + limited.x * downwind + limited.y * left;
}

}  // namespace understory
