// The wind against closed forms, an independent Fourier sum, an integrated oscillator and a measured record.
#include "sim/wind.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "tests/support/data.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/temporary_file.hpp"

namespace understory {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double pi = std::numbers::pi;

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double deviation(const std::vector<double>& values) {
  const double middle = mean(values);
  double sum = 0;
  for (double value : values) sum += (value - middle) * (value - middle);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// One-sided power density at a bin, (m/s)^2/Hz, by a plain sum.
double power_density(const std::vector<double>& values, double rate, int bin) {
  std::complex<double> sum = 0;
  const double count = static_cast<double>(values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    sum += std::polar(values[i], -2 * pi * std::fmod(static_cast<double>(bin) * static_cast<double>(i), count) / count);
  return 2 * std::norm(sum) / (count * rate);
}

/// Slope of the regression of log y on log x.
double log_slope(const std::vector<double>& x, const std::vector<double>& y) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double a = std::log(x[i]), b = std::log(y[i]);
    sx += a, sy += b, sxx += a * a, sxy += a * b;
  }
  const double n = static_cast<double>(x.size());
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

WindSource breeze() {
  WindSource source;
  source.speed = 6;
  source.turbulence_intensity = 0.2;
  source.length_scale = 60;
  return source;
}

TEST(Wind, FollowsTheLogProfile) {
  WindSource source = breeze();
  source.roughness_length = 0.03;
  source.displacement_height = 0.2;
  source.direction = 2.5;
  const Wind wind(source, 1);
  EXPECT_NEAR(wind.mean_speed(10), 6, 1e-12);
  EXPECT_NEAR(wind.mean_speed(2), 6 * std::log(1.8 / 0.03) / std::log(9.8 / 0.03), 1e-12);
  EXPECT_EQ(wind.mean_speed(0.23), 0);
  EXPECT_EQ(wind.mean_speed(0), 0);
  EXPECT_EQ(wind.mean_speed(-5), 0);
  EXPECT_GT(wind.mean_speed(0.231), 0);
  EXPECT_NEAR(wind.direction().x, std::cos(2.5), 1e-15);
  EXPECT_NEAR(wind.direction().y, std::sin(2.5), 1e-15);
  EXPECT_NEAR(wind.convection_speed(), 6, 1e-12);
}

TEST(SyntheticGusts, HaveTheStatedTurbulenceIntensity) {
  for (double intensity : {0.05, 0.25, 0.6}) {
    WindSource source = breeze();
    source.turbulence_intensity = intensity;
    const GustSeries gusts = Wind(source, 17).gusts();
    EXPECT_EQ(gusts.along.size(), 32768u);
    EXPECT_NEAR(mean(gusts.along), 0, 1e-12);
    EXPECT_NEAR(deviation(gusts.along) / source.speed, intensity, 1e-12);
    EXPECT_NEAR(deviation(gusts.across) / source.speed, 0.8 * intensity, 1e-12);
  }
}

TEST(SyntheticGusts, FallAsFiveThirdsInTheInertialRange) {
  const GustSeries gusts = Wind(breeze(), 5).gusts();
  std::vector<double> frequency, along, across;
  for (int bin = 1500; bin < 15000; bin += 450) {  // 1.5 to 15 Hz: eddies of 4 to 0.4 m
    frequency.push_back(bin / 1024.0);
    along.push_back(power_density(gusts.along, gusts.rate, bin));
    across.push_back(power_density(gusts.across, gusts.rate, bin));
  }
  EXPECT_NEAR(log_slope(frequency, along), -5.0 / 3, 0.01);
  EXPECT_NEAR(log_slope(frequency, across), -5.0 / 3, 0.01);
  // Isotropy: across the wind 4/3 of the density along it; the deviations of the surface layer give 0.8^2 of that.
  EXPECT_NEAR(across.back() / along.back(), 0.64 * 4 / 3, 0.03);
}

TEST(SyntheticGusts, HaveATwoThirdsStructureFunctionAndTheStatedIntegralLength) {
  const GustSeries gusts = Wind(breeze(), 6).gusts();
  std::vector<double> lag, difference;
  for (std::size_t step : {4u, 6u, 8u, 12u, 16u, 24u}) {  // 1/8 to 3/4 s
    double sum = 0;
    for (std::size_t i = 0; i < gusts.along.size(); ++i)
      sum += std::pow(gusts.along[(i + step) % gusts.along.size()] - gusts.along[i], 2);
    lag.push_back(static_cast<double>(step));
    difference.push_back(sum);
  }
  EXPECT_NEAR(log_slope(lag, difference), 2.0 / 3, 0.07);
  // Density at zero frequency is 4 sigma^2 L / U; bin 1 (1024 s) is close to it.
  const double expected = 4 * std::pow(0.2 * 6, 2) * 60 / 6;
  EXPECT_NEAR(power_density(gusts.along, gusts.rate, 1) / expected, 1, 0.05);
}

TEST(SyntheticGusts, DependOnTheSeedAlone) {
  const GustSeries one = Wind(breeze(), 1).gusts(), again = Wind(breeze(), 1).gusts(), two = Wind(breeze(), 2).gusts();
  EXPECT_EQ(one.along, again.along);
  EXPECT_EQ(one.across, again.across);
  const auto correlation = [](const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum / static_cast<double>(a.size()) / deviation(a) / deviation(b);
  };
  EXPECT_LT(std::abs(correlation(one.along, two.along)), 0.25);  // some fifty independent eddies in a period
  EXPECT_LT(std::abs(correlation(one.along, one.across)), 0.25);
  double fourth = 0;
  for (double value : one.along) fourth += std::pow(value, 4);
  EXPECT_NEAR(fourth / static_cast<double>(one.along.size()) / std::pow(deviation(one.along), 4), 3, 0.5);
}

TEST(Response, OfASteadyWindIsTheStaticAngle) {
  WindSource source = breeze();
  source.turbulence_intensity = 0;
  const Wind wind(source, 1);
  const ModalSeries series = wind.respond({0.7, 0.05, 0.2}, 10);
  const double angle = 0.2 * 0.36;
  EXPECT_NEAR(series.mean, 1.2 * std::tanh(angle / 1.2), 1e-12);
  for (double time : {0.0, 3.7, 1e6}) {
    EXPECT_EQ(series.at(time).x, series.mean);
    EXPECT_EQ(series.at(time).y, 0);
  }
  EXPECT_LT(wind.respond({0.7, 0.05, 0.2}, 2).mean, series.mean);
}

TEST(Response, EqualsAnIntegratedOscillator) {
  const Wind wind(breeze(), 9);
  const SwayMode mode{0.6, 0.08, 0.002};  // small: the limit of the tip angle does not matter
  const ModalSeries series = wind.respond(mode, 10);
  const std::vector<double>& gusts = wind.gusts().along;

  // theta'' + 2 zeta w theta' + w^2 theta = w^2 force, from rest, Runge-Kutta; its start is forgotten after 200 s.
  const double omega = 2 * pi * mode.frequency, step = 1.0 / 32;
  const auto force = [&](std::size_t i) { return mode.deflection * (36 + 12 * gusts[i % gusts.size()]) / 100; };
  const auto acceleration = [&](double angle, double rate, double push) {
    return omega * omega * (push - angle) - 2 * mode.damping * omega * rate;
  };
  double angle = 0, rate = 0, squared_error = 0, squared_size = 0;
  int compared = 0;
  for (std::size_t i = 0; i < 20000; ++i) {
    if (i >= 6400) {
      squared_error += std::pow(series.at(static_cast<double>(i) * step).x - angle, 2);
      squared_size += std::pow(angle - series.mean, 2);
      ++compared;
    }
    const double now = force(i), next = force(i + 1), half = 0.5 * (now + next);
    const double a1 = acceleration(angle, rate, now), r2 = rate + 0.5 * step * a1;
    const double a2 = acceleration(angle + 0.5 * step * rate, r2, half), r3 = rate + 0.5 * step * a2;
    const double a3 = acceleration(angle + 0.5 * step * r2, r3, half), r4 = rate + step * a3;
    const double a4 = acceleration(angle + step * r3, r4, next);
    angle += step / 6 * (rate + 2 * r2 + 2 * r3 + r4);
    rate += step / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  EXPECT_GT(squared_size, 0);
  EXPECT_LT(std::sqrt(squared_error / squared_size), 0.01) << compared << " samples";
}

TEST(Response, OfStillAirIsExactlyZero) {
  WindSource source = breeze();
  source.speed = 0;
  const Wind wind(source, 3);
  const ModalSeries series = wind.respond({0.4, 0.1, 0.5}, 8);
  EXPECT_EQ(wind.mean_speed(30), 0);
  EXPECT_GT(wind.convection_speed(), 0);
  EXPECT_THAT(wind.gusts().along, testing::Each(0.0));
  EXPECT_EQ(series.mean, 0);
  EXPECT_THAT(series.along, testing::Each(0.0f));
  EXPECT_THAT(series.across, testing::Each(0.0f));
}

TEST(Response, StaysFiniteAndBelowItsLimitAtTheExtremes) {
  for (double speed : {1e-200, 1e-4, 100.0, 200.0})
    for (double length : {0.1, 40.0, 1e5})
      for (const SwayMode& mode : {SwayMode{0.3, 0, 1}, SwayMode{1e-6, 0, 50}, SwayMode{1e6, 3, 1e-9}}) {
        WindSource source = breeze();
        source.speed = speed;
        source.length_scale = length;
        source.turbulence_intensity = 2;
        const ModalSeries series = Wind(source, 4).respond(mode, 25);
        double largest = 0;
        for (std::size_t i = 0; i < series.along.size(); ++i)
          largest = std::fmax(largest, std::hypot(series.mean + series.along[i], series.across[i]));
        for (float value : series.along) ASSERT_TRUE(std::isfinite(value));
        for (float value : series.across) ASSERT_TRUE(std::isfinite(value));
        EXPECT_LE(largest, largest_tip_angle * (1 + 1e-6)) << speed << " m/s, " << length << " m";
      }
}

TEST(ModalSeries, InterpolatesAndRepeats) {
  const ModalSeries series{2, 10, {0, 1, 4, -1}, {0, 0, 8, 0}};
  EXPECT_EQ(series.at(0), glm::dvec2(10, 0));
  EXPECT_EQ(series.at(0.75), glm::dvec2(12.5, 4));
  EXPECT_EQ(series.at(1.75), glm::dvec2(9.5, 0));  // between the last sample and the first
  EXPECT_EQ(series.at(2.75), series.at(0.75));
  EXPECT_EQ(series.at(-1.25), series.at(0.75));
  EXPECT_EQ(series.at(-1e-30), glm::dvec2(10, 0));
  EXPECT_EQ(series.at(2e9 + 0.5), series.at(0.5));
  EXPECT_EQ(ModalSeries().at(3), glm::dvec2(0));
}

TEST(Wind, SaysWhatIsWrong) {
  const auto message = [](auto change) {
    WindSource source = breeze();
    change(source);
    return message_of(ErrorKind::invalid_input, [&] { Wind(source, 1); });
  };
  EXPECT_THAT(message([](WindSource& s) { s.speed = -1; }), AllOf(HasSubstr("wind.speed"), HasSubstr("-1")));
  EXPECT_THAT(message([](WindSource& s) { s.speed = std::nan(""); }), HasSubstr("wind.speed"));
  EXPECT_THAT(message([](WindSource& s) { s.roughness_length = 0; }), HasSubstr("wind.roughness_length"));
  EXPECT_THAT(message([](WindSource& s) { s.reference_height = 0.05; }), HasSubstr("wind.reference_height"));
  EXPECT_THAT(message([](WindSource& s) { s.turbulence_intensity = -0.1; }), HasSubstr("wind.turbulence_intensity"));
  EXPECT_THAT(message([](WindSource& s) { s.length_scale = 0; }), HasSubstr("wind.length_scale"));
  EXPECT_THAT(message_of(ErrorKind::invalid_input,
                         [] {
                           Wind(breeze(), 1).respond({0, 0.1, 0.1}, 5);
                         }),
              HasSubstr("frequency"));
}

/// A record of `count` samples at 10 Hz whose wind blows with `speed(seconds)` towards `angle`.
template <typename Speed>
std::string record_text(int count, double angle, Speed speed) {
  std::string text = "time_s,u_ms,v_ms\n";
  for (int i = 0; i < count; ++i) {
    const double value = speed(0.1 * i);
    text += fmt::format("{:.1f},{:.9f},{:.9f}\n", 0.1 * i, value * std::cos(angle), value * std::sin(angle));
  }
  return text;
}

Wind wind_of(const std::filesystem::path& record, double record_height = 2) {
  WindSource source;
  source.direction = 1;
  source.record = record;
  source.record_height = record_height;
  return Wind(source, 1);
}

TEST(WindRecord, IsTurnedIntoItsMeanDirectionAndKeepsItsFluctuation) {
  const auto speed = [](double t) {
    return 3 + 0.5 * std::sin(2 * pi * 0.7 * t) + 0.2 * std::sin(2 * pi * 1.9 * t + 1);
  };
  const TemporaryFile file("record.csv", record_text(4003, 2.2, speed));
  const Wind wind = wind_of(file.path());
  EXPECT_NEAR(wind.mean_speed(2), 3, 1e-3);
  EXPECT_GT(wind.mean_speed(10), 3);
  EXPECT_NEAR(wind.convection_speed(), 3, 1e-3);
  EXPECT_NEAR(wind.direction().x, std::cos(1), 1e-12);  // the scene's, not the record's
  const GustSeries& gusts = wind.gusts();
  EXPECT_EQ(gusts.along.size(), 4096u);
  EXPECT_NEAR(mean(gusts.along), 0, 1e-9);
  EXPECT_LT(deviation(gusts.across), 1e-6);
  // After the cross-fade (40 s), sample for sample the signal that was recorded.
  double largest = 0;
  for (std::size_t i = 600; i < 3900; ++i)
    largest = std::max(largest, std::abs(3 + gusts.along[i] - speed(static_cast<double>(i) / gusts.rate)));
  EXPECT_LT(largest, 0.01);
}

TEST(WindRecord, SaysWhatIsWrong) {
  const auto message = [](const std::string& text) {
    const TemporaryFile file("record.csv", text);
    return message_of(ErrorKind::invalid_input, [&] { wind_of(file.path()); });
  };
  const auto calm = [](double) { return 1.0; };
  std::string text = record_text(200, 0, calm);
  EXPECT_THAT(message(record_text(20, 0, calm)), AllOf(HasSubstr("20 samples"), HasSubstr("at least 64")));
  text.replace(text.find("\n5.0,") + 1, 3, "5.3");
  EXPECT_THAT(message(text), AllOf(HasSubstr("record.csv:52"), HasSubstr("time_s"), HasSubstr("equally spaced")));
  text = record_text(200, 0, [](double t) { return t > 7.95 ? -9999.0 : 1.0; });
  EXPECT_THAT(message(text), AllOf(HasSubstr("record.csv:82"), HasSubstr("u_ms"), HasSubstr("-9999")));
  text = record_text(200, 0, calm);
  text.replace(0, 16, "seconds,u_ms,v_ms");
  EXPECT_THAT(message(text), AllOf(HasSubstr("'timestamp'"), HasSubstr("'time_s'")));
  text = record_text(200, 0, calm);
  text.replace(0, 16, "time_s,u_ms,w_ms");
  EXPECT_THAT(message(text), HasSubstr("no column 'v_ms'"));
  EXPECT_THROW(wind_of("/nowhere/record.csv"), Error);
}

TEST(WindRecord, OfDavosDrivesTheScene) {
  UNDERSTORY_NEEDS_DATA();
  const Wind wind = wind_of(data_folder() / "measured/wind_20hz_davos_subcanopy.csv", 1.5);
  EXPECT_NEAR(wind.mean_speed(1.5), std::hypot(-0.459606, 0.138609), 1e-5);
  const GustSeries& gusts = wind.gusts();
  EXPECT_EQ(gusts.along.size(), 16384u);
  EXPECT_NEAR(static_cast<double>(gusts.along.size()) / gusts.rate, 675, 1e-6);  // 12.5 min less the cross-fade
  // Deviations of the raw file about its mean direction (awk): 0.315 along, 0.241 across.
  EXPECT_NEAR(deviation(gusts.along), 0.315, 0.03);
  EXPECT_NEAR(deviation(gusts.across), 0.241, 0.025);
  double largest_step = 0;
  for (std::size_t i = 1; i < gusts.along.size(); ++i)
    largest_step = std::max(largest_step, std::abs(gusts.along[i] - gusts.along[i - 1]));
  EXPECT_LT(std::abs(gusts.along.front() - gusts.along.back()), 0.5 * largest_step);
  const ModalSeries sway = wind.respond({0.3, 0.1, 0.3}, 12);
  EXPECT_GT(sway.mean, 0);
  EXPECT_GT(*std::max_element(sway.along.begin(), sway.along.end()), 0);
}

}  // namespace
}  // namespace understory
