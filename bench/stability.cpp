#include "bench/stability.hpp"

#include <algorithm>
#include <cmath>

#include "bench/stability_case.hpp"

namespace understory {
namespace {

/// A fall or jump that rounding explains: two values, each off by a few units in the last place of numbers up to 1.
constexpr double rounding = 1e-6;

std::vector<StabilityCase> all_cases(std::size_t samples) {
  std::vector<StabilityCase> all;
  const auto add = [&](std::vector<StabilityCase> more) {
    std::move(more.begin(), more.end(), std::back_inserter(all));
  };
  add(table_stability(samples));
  add(crown_stability(samples));
  add(transmittance_stability(samples));
  add(sphere_stability(samples));
  add(grid_stability(samples));
  add(image_stability(samples));
  add(pose_stability());
  add(frame_stability());
  return all;
}

bool within(float v) { return v >= 0 && v <= 1; }

/// Error of every value. What exceeds the bar by no more than eight units in the last place of the inputs change
/// passes: kernels round about as often on the way.
void judge_errors(const StabilityCase& one, const std::vector<double>& exact, const std::vector<float>& v,
                  StabilityRow& row) {
  double worst_excess = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (std::isnan(exact[i])) continue;
    const double error = std::isfinite(v[i]) ? std::abs(double(v[i]) - exact[i]) : 1;
    const bool over = error > row.bar;
    const double unknowable = over && one.last_place ? one.last_place(i) : 0;
    if (!row.max_abs_error || error > *row.max_abs_error) {
      row.max_abs_error = error;
      row.last_place = unknowable;
    }
    worst_excess = std::max(worst_excess, error - 8 * unknowable);
  }
  if (worst_excess > row.bar) row.passed = false;
  if (row.passed && row.max_abs_error.value_or(0) > row.bar)
    row.reason = "ill-conditioned, units in the last place of the inputs change V as much" +
                 (one.conditioning.empty() ? "" : ": " + one.conditioning);
}

void judge_neighbours(const StabilityCase& one, const std::vector<double>& exact, const std::vector<float>& v,
                      StabilityRow& row) {
  for (const auto& [a, b] : one.neighbours) {
    const double slope = exact.empty() || one.stated_jump > 0 ? 0 : std::abs(exact[a] - exact[b]);
    const double jump = std::max(std::abs(double(v[a]) - double(v[b])) - slope, 0.0);
    row.largest_jump = std::max(row.largest_jump.value_or(0), jump);
  }
  if (row.largest_jump.value_or(0) > 2 * row.bar + one.stated_jump + rounding) row.passed = false;
  for (const std::vector<std::size_t>& order : one.rising)
    for (std::size_t k = 1; k < order.size(); ++k)
      row.largest_fall = std::max(row.largest_fall.value_or(0), double(v[order[k - 1]]) - double(v[order[k]]));
  if (row.largest_fall.value_or(0) > 2 * one.stated_error + rounding) row.passed = false;
}

StabilityRow judge(const StabilityCase& one, const std::vector<double>& exact, const Shaded& shaded) {
  StabilityRow row;
  row.kernel = one.kernel;
  row.name = one.name;
  row.extreme = one.extreme;
  row.values = shaded.visibility.size();
  row.stated_error = one.stated_error;
  row.bar = (one.extreme ? extreme_bar : normal_bar) + one.stated_error;
  row.note = row.reason = one.note;
  for (const float v : shaded.visibility) {
    row.finite &= std::isfinite(v);
    row.in_range &= within(v);
    row.lowest = std::min(row.lowest, double(v));
    row.highest = std::max(row.highest, double(v));
  }
  row.passed = row.finite && row.in_range;
  if (!exact.empty()) judge_errors(one, exact, shaded.visibility, row);
  judge_neighbours(one, exact, shaded.visibility, row);
  for (const std::uint32_t codes : shaded.validity)
    for (std::uint32_t bit = 0; bit < 32; ++bit)
      if (codes >> bit & 1u) ++row.validity[1u << bit];
  return row;
}

void measure_relaxed(const std::vector<double>& exact, const Shaded& shaded, StabilityRow& row) {
  for (std::size_t i = 0; i < shaded.visibility.size(); ++i) {
    const float v = shaded.visibility[i];
    row.relaxed_finite &= std::isfinite(v);
    row.relaxed_in_range &= within(v);
    if (exact.empty() || std::isnan(exact[i])) continue;
    const double error = std::isfinite(v) ? std::abs(double(v) - exact[i]) : 1;
    row.relaxed_max_abs_error = std::max(row.relaxed_max_abs_error.value_or(0), error);
  }
}

}  // namespace

std::size_t StabilityReport::failures() const {
  return static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), [](const auto& row) { return !row.passed; }));
}

StabilityReport run_stability(const std::string& device_name, const StabilityOptions& options) {
  Device device(device_name);
  std::optional<Device> relaxed;
  if (options.relaxed) relaxed.emplace(std::to_string(device.info().index), "-cl-fast-relaxed-math");
  StabilityReport report;
  report.device = device.info();
  report.relaxed = options.relaxed;
  std::vector<StabilityCase> cases = all_cases(options.samples);
  std::erase_if(cases, [&](const auto& one) { return one.kernel.find(options.filter) == std::string::npos; });
  for (const StabilityCase& one : cases) {
    const Shaded shaded = one.shade(device);
    std::vector<double> exact(one.exact ? shaded.visibility.size() : 0);
    for (std::size_t i = 0; i < exact.size(); ++i) exact[i] = one.exact(i);
    report.rows.push_back(judge(one, exact, shaded));
    if (relaxed) measure_relaxed(exact, one.shade(*relaxed), report.rows.back());
    if (options.progress) options.progress(cases.size(), one.kernel);
  }
  return report;
}

}  // namespace understory
