#include "host/trace/calibrate.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "host/trace/crown_points.hpp"
#include "host/trace/shell_models.hpp"

namespace understory {
namespace {

/// Mean square error of a model's values on the points of one half: even ones fit, odd ones are held out.
double mean_square(const std::vector<double>& model, const std::vector<float>& truth, std::size_t half) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = half; i < truth.size(); i += 2, ++count) {
    const double error = model[i] - double(truth[i]);
    sum += error * error;
  }
  return count ? sum / static_cast<double>(count) : 0;
}

/// The factor in [0, 1] by which a model's values come closest to the truth of the fitted half.
double best_factor(const std::vector<double>& model, const std::vector<float>& truth) {
  double product = 0, square = 0;
  for (std::size_t i = 0; i < truth.size(); i += 2)
    product += model[i] * double(truth[i]), square += model[i] * model[i];
  return square > 0 ? std::clamp(product / square, 0.0, 1.0) : 1;
}

/// The rate of least error in [low, high], on a logarithmic scale: a scan, for there may be several valleys, then
/// golden sections in the deepest.
double best_rate(double low, double high, const std::function<double(double)>& error) {
  constexpr int steps = 20, sections = 10;
  const double step = std::log(high / low) / steps;
  int best = 0;
  double least = error(low);
  for (int i = 1; i <= steps; ++i)
    if (const double here = error(low * std::exp(i * step)); here < least) least = here, best = i;
  double a = std::log(low) + (best - 1) * step, b = std::log(low) + (best + 1) * step;
  const double golden = 0.6180339887498949;
  double c = b - golden * (b - a), d = a + golden * (b - a), at_c = error(std::exp(c)), at_d = error(std::exp(d));
  for (int i = 0; i < sections; ++i) {
    if (at_c < at_d) {
      b = d, d = c, at_d = at_c;
      c = b - golden * (b - a), at_c = error(std::exp(c));
    } else {
      a = c, c = d, at_c = at_d;
      d = a + golden * (b - a), at_d = error(std::exp(d));
    }
  }
  return std::exp(0.5 * (a + b));
}

std::vector<double> decays(const std::vector<double>& weights, double rate) {
  std::vector<double> values;
  for (const double weight : weights) values.push_back(std::exp(-rate * weight));
  return values;
}

class Fitting {
 public:
  Fitting(const Prototype& prototype, const CrownPoints& points, Calibration& result)
      : crown_(prototype.crown), points_(points), result_(result) {}

  void constant() {
    const std::vector<double> ones(points_.visibility.size(), 1);
    result_.ambient = best_factor(ones, points_.visibility);
    score("ambient", std::vector<double>(ones.size(), result_.ambient));
  }

  void reeves_blau(double given_ambient) {
    std::vector<double> depths;
    for (const glm::vec3& p : points_.positions)
      depths.push_back(std::max(0.0f, crown_.sphere_radius - glm::distance(p, crown_.sphere_centre)));
    const auto scaled = [&](double rate) {
      std::vector<double> values = decays(depths, rate);
      const double ambient = given_ambient > 0 ? given_ambient : best_factor(values, points_.visibility);
      for (double& value : values) value *= ambient;
      result_.model.reeves_blau_ambient = static_cast<float>(ambient);
      return values;
    };
    const double radius = crown_.sphere_radius;
    const double rate =
        best_rate(1e-3 / radius, 1e3 / radius, [&](double x) { return mean_square(scaled(x), points_.visibility, 0); });
    score("reeves-blau", scaled(rate));
    result_.model.reeves_blau_extinction = static_cast<float>(rate);
  }

  /// Eq. 6 with the caps of `weights`.
  float cap(const char* method, const std::vector<double>& weights) {
    const double volume = std::pow(double(crown_.sphere_radius), 3);
    const double rate = best_rate(1e-4 / volume, 1e5 / volume,
                                  [&](double x) { return mean_square(decays(weights, x), points_.visibility, 0); });
    score(method, decays(weights, rate));
    return static_cast<float>(rate);
  }

  void caps() {
    CrownModel& model = result_.model;
    model.alpha_rho = cap("sphere-cap", cap_weights(crown_, points_, CapShell::sphere));
    model.alpha_rho_ellipsoid = cap("ellipsoid-cap", cap_weights(crown_, points_, CapShell::ellipsoid));
    model.alpha_rho_shells = cap("shells-cap", cap_weights(crown_, points_, CapShell::nearest));
    model.alpha_rho_levels = cap("shells-cap-levels", cap_weights(crown_, points_, CapShell::levels));
  }

  void transmittance(const char* name, CrownShape shape) {
    std::array<double, 3> constants{};  // k, near share, scale of the shell
    std::vector<double> fitted;
    double least = 1e9;
    const auto try_scale = [&](double scale) {
      const ShellChords chords(shells_of(crown_, shape, scale), points_);
      double factor = 1;
      const auto scaled = [&](double k) {
        std::vector<double> values = chords.visibility(k);
        factor = best_factor(values, points_.visibility);
        for (double& value : values) value *= factor;
        return values;
      };
      const double radius = crown_.sphere_radius;
      const double k = best_rate(1e-2 / radius, 1e3 / radius,
                                 [&](double x) { return mean_square(scaled(x), points_.visibility, 0); });
      const std::vector<double> values = scaled(k);
      const double error = mean_square(values, points_.visibility, 0);
      if (error >= least) return;
      least = error;
      fitted = values;
      constants = {k, factor, scale};
    };
    // The rim is sparse. A dense crown goes dark within a fiftieth of its radius: there hundredths count.
    for (const double scale : {1.0, 0.92, 0.84, 0.76}) try_scale(scale);
    for (const double step : {0.04, 0.02, 0.01}) {
      const double middle = constants[2];
      if (middle + step <= 1) try_scale(middle + step);
      try_scale(middle - step);
    }
    const double error = score(std::string("crown-transmittance/") + name, fitted);
    result_.transmittance[name] = constants;
    double& best = result_.rmse_heldout.try_emplace("crown-transmittance", 2).first->second;
    if (error >= best) return;
    best = error;
    result_.model.shape = shape;
    result_.model.extinction = static_cast<float>(constants[0]);
    result_.model.near_share = static_cast<float>(constants[1]);
    result_.model.shell_scale = static_cast<float>(constants[2]);
  }

 private:
  double score(const std::string& method, const std::vector<double>& values) {
    return result_.rmse_heldout[method] = std::sqrt(mean_square(values, points_.visibility, 1));
  }

  const CrownShell& crown_;
  const CrownPoints& points_;
  Calibration& result_;
};

/// Share of the lines that cross a sphere and are blocked in it.
double blocked_share(const std::vector<std::int8_t>& blocked) {
  double crossing = 0, hits = 0;
  for (const std::int8_t state : blocked) crossing += state >= 0, hits += state == 1;
  return crossing > 0 ? hits / crossing : 0;
}

/// How much each sphere's disc blocks. The clustered ones overlap: each transmittance is raised to the one power with
/// which their product over the spheres that a line crosses is right on average.
void measure_opacity(const CrownShell& crown, const Tracer& tracer, const std::vector<CrownLine>& lines,
                     CrownModel& model) {
  const Sphere whole{glm::dvec3(crown.sphere_centre), double(crown.sphere_radius)};
  const std::vector<std::int8_t> in_whole = blocked_within(tracer, lines, whole);
  model.opacity = static_cast<float>(blocked_share(in_whole));
  std::vector<double> depth(lines.size(), 0), own;  // -log of the transmittance that a line meets; of each sphere
  std::vector<bool> crosses(lines.size(), false);
  for (const glm::vec4& shell : crown.shells) {
    const auto in_shell = blocked_within(tracer, lines, {glm::dvec3(shell), double(shell.w)});
    own.push_back(-std::log1p(-std::min(blocked_share(in_shell), 0.9999)));
    for (std::size_t i = 0; i < lines.size(); ++i)
      if (in_shell[i] >= 0) depth[i] += own.back(), crosses[i] = true;
  }
  double crossing = 0, open = 0;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (crosses[i]) crossing += 1, open += in_whole[i] == 0;
  const auto modelled = [&](double power) {
    double sum = 0;
    for (std::size_t i = 0; i < lines.size(); ++i)
      if (crosses[i]) sum += std::exp(-power * depth[i]);
    return sum;
  };
  double low = 0, high = 8;
  for (int step = 0; step < 40; ++step) {
    const double middle = 0.5 * (low + high);
    (modelled(middle) > open ? low : high) = middle;
  }
  model.shell_opacity.clear();
  for (const double own_depth : own) model.shell_opacity.push_back(static_cast<float>(-std::expm1(-low * own_depth)));
}

/// k from the open share of lines through the ellipsoid: even ones fit, odd ones tell the error.
void measure_extinction(const CrownShell& crown, const Tracer& tracer, const std::vector<CrownLine>& lines,
                        Calibration& result) {
  const std::vector<Chord> chords = ellipsoid_chords(crown, lines);
  std::vector<Ray> rays;
  for (const Chord& chord : chords)
    rays.push_back({lines[chord.line].origin, chord.enter, lines[chord.line].direction, chord.leave});
  std::vector<std::uint8_t> blocked(rays.size());
  tracer.blocked(rays, blocked);
  const auto surplus = [&](double k, std::size_t half) {  // modelled less traced open share
    double sum = 0, count = 0;
    for (std::size_t i = half; i < chords.size(); i += 2, ++count)
      sum += std::exp(-k * double(chords[i].leave - chords[i].enter)) - (1 - blocked[i]);
    return count > 0 ? sum / count : 0;
  };
  double low = 0, high = 1e3 / double(crown.sphere_radius);
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (surplus(middle, 0) > 0 ? low : high) = middle;
  }
  result.k = 0.5 * (low + high);
  result.open_error = surplus(result.k, 1);
  const double leaf_angle_factor = 0.5;
  result.clumping = result.pad_mean > 0 ? result.k / (leaf_angle_factor * result.pad_mean) : 0;
}

}  // namespace

Calibration calibrate(const Prototype& prototype, double ambient_of_reeves_blau, const CalibrationOptions& options) {
  Calibration result;
  const CrownShell& crown = prototype.crown;
  if (crown.sphere_radius <= 0) return result;
  result.leaf_area = crown.leaf_area;
  result.plant_area = crown.plant_area;
  const glm::dvec3 radii(crown.ellipsoid_radii);
  const double volume = 4 * std::numbers::pi / 3 * radii.x * radii.y * radii.z;
  result.lad_mean = result.leaf_area / volume;
  result.pad_mean = result.plant_area / volume;
  result.density = density_grid(prototype);

  const Tracer tracer = trace_prototype(prototype);
  const Sphere sphere{glm::dvec3(crown.sphere_centre), double(crown.sphere_radius)};
  const std::vector<CrownLine> lines = random_lines(sphere, options.lines, options.seed + 7);
  measure_opacity(crown, tracer, lines, result.model);
  measure_extinction(crown, tracer, lines, result);

  const CrownPoints points = seen_points(tracer, prototype, options.points, options.rays, options.seed);
  result.points = points.positions.size();
  Fitting fitting(prototype, points, result);
  fitting.constant();
  fitting.reeves_blau(ambient_of_reeves_blau);
  fitting.caps();
  fitting.transmittance("sphere", CrownShape::sphere);
  fitting.transmittance("ellipsoid", CrownShape::ellipsoid);
  fitting.transmittance("shells", CrownShape::shells);
  return result;
}

}  // namespace understory
