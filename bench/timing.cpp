// Two clocks around each launch, and order statistics of the samples.
#include "bench/timing.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "sim/error.hpp"

namespace understory {
namespace {

using Clock = std::chrono::steady_clock;

/// Milliseconds of one action, one entry a run.
struct Samples {
  std::vector<double> device, wall;
  std::map<std::string, std::vector<double>> kernels;
  /// What runs on the host alone takes no time on the device.
  const std::vector<double>& times() const { return kernels.empty() ? wall : device; }
};

void run_once(Device& device, const std::function<void()>& action, Samples* samples) {
  device.take_kernel_times();
  const double wall = wall_milliseconds(device, action);
  double sum = 0;
  const std::map<std::string, double> times = device.take_kernel_times();
  for (const auto& [kernel, milliseconds] : times) sum += milliseconds;
  if (samples == nullptr) return;
  for (const auto& [kernel, milliseconds] : times) samples->kernels[kernel].push_back(milliseconds);
  samples->device.push_back(sum);
  samples->wall.push_back(wall);
}

/// Whether every action's interval is narrow enough.
bool is_narrow(const std::vector<Samples>& all, double precision) {
  return std::all_of(all.begin(), all.end(),
                     [&](const Samples& samples) { return spread_of(samples.times()).half_width() <= precision; });
}

}  // namespace

Spread95 spread_of(std::vector<double> samples) {
  if (samples.empty()) throw Error(ErrorKind::unexpected, "a benchmark took no samples");
  std::sort(samples.begin(), samples.end());
  const std::size_t count = samples.size(), last = count - 1;
  // The rank of the median is binomial(n, 1/2): mean n/2, deviation sqrt(n)/2.
  const double n = static_cast<double>(count), reach = 1.96 * std::sqrt(n) / 2;
  const auto rank = static_cast<std::size_t>(std::max(0.0, std::floor((n - 1) / 2 - reach)));
  return {(samples[last / 2] + samples[count / 2]) / 2, samples[rank], samples[last - rank]};
}

double wall_milliseconds(Device& device, const std::function<void()>& action) {
  const auto start = Clock::now();
  action();
  device.finish();
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

std::vector<MeasuredTime> time_in_turn(Device& device, const std::vector<std::function<void()>>& actions,
                                       const StopRule& stop) {
  const std::size_t count = actions.size();
  std::vector<Samples> samples(count);
  if (stop.warm_up)
    for (const auto& action : actions) run_once(device, action, nullptr);
  const auto start = Clock::now();
  int runs = 0;
  do {
    for (std::size_t turn = 0; turn < count; ++turn) {
      const std::size_t i = runs % 2 == 0 ? turn : count - 1 - turn;
      run_once(device, actions[i], &samples[i]);
    }
    ++runs;
  } while (runs < stop.least || (runs < stop.most && !is_narrow(samples, stop.precision) &&
                                 Clock::now() - start < std::chrono::duration<double>(stop.seconds)));
  std::vector<MeasuredTime> times;
  for (const Samples& of : samples) {
    MeasuredTime time{spread_of(of.device), spread_of(of.wall), {}, runs};
    for (const auto& [kernel, milliseconds] : of.kernels) time.kernels[kernel] = spread_of(milliseconds);
    times.push_back(time);
  }
  return times;
}

}  // namespace understory
