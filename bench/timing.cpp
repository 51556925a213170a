// Two clocks around each launch, and order statistics of the samples.
#include "bench/timing.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "sim/error.hpp"

namespace understory {

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
  const auto start = std::chrono::steady_clock::now();
  action();
  device.finish();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

std::vector<MeasuredTime> time_in_turn(Device& device, const std::vector<std::function<void()>>& actions,
                                       int repetitions) {
  std::vector<std::vector<double>> device_ms(actions.size()), wall_ms(actions.size());
  const std::size_t count = actions.size();
  for (int repetition = -1; repetition < repetitions; ++repetition) {
    for (std::size_t turn = 0; turn < count; ++turn) {
      const std::size_t i = repetition % 2 == 0 ? turn : count - 1 - turn;
      device.take_pass_times();
      const double wall = wall_milliseconds(device, actions[i]);
      double sum = 0;
      for (const auto& [pass, milliseconds] : device.take_pass_times()) sum += milliseconds;
      if (repetition < 0) continue;
      device_ms[i].push_back(sum);
      wall_ms[i].push_back(wall);
    }
  }
  std::vector<MeasuredTime> times;
  for (std::size_t i = 0; i < actions.size(); ++i) times.push_back({spread_of(device_ms[i]), spread_of(wall_ms[i])});
  return times;
}

}  // namespace understory
