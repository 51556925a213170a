// Repeated measurements of things that run on a device, taken in turn so that drift of the machine meets all alike.
// (Google Benchmark runs one after the other: a ratio of two of its figures holds the drift between them.)
#pragma once
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "host/opencl/device.hpp"

namespace understory {

/// Milliseconds. The interval holds the true median with 95 % confidence (order statistics).
struct Spread95 {
  double median = 0, low = 0, high = 0;
  /// Half the interval's width over the median.
  double half_width() const { return median > 0 ? (high - low) / (2 * median) : 0; }
};

/// Throws Error(unexpected) for no samples.
Spread95 spread_of(std::vector<double> samples);

/// When to stop repeating: after `least` runs, as soon as every interval is as narrow as `precision` (half_width), and
/// at the latest after `most` runs or `seconds`.
struct StopRule {
  int least = 9, most = 200;
  double precision = 0.02;
  double seconds = 0.4;
  bool warm_up = true;  // one untimed run first
};

/// Just so many runs.
constexpr StopRule exactly(int runs) { return {runs, runs, 0, 0, true}; }
/// What takes seconds.
inline constexpr StopRule once{1, 1, 0, 0, false};

struct MeasuredTime {
  Spread95 device_ms;                       // sum over the launches, from the device's own clock
  Spread95 wall_ms;                         // from the first call to the last result, on the host
  std::map<std::string, Spread95> kernels;  // device_ms by kernel function
  int runs = 0;
};

/// Runs all `actions` once each, over and over, forwards and backwards by turns.
std::vector<MeasuredTime> time_in_turn(Device& device, const std::vector<std::function<void()>>& actions,
                                       const StopRule& stop);

/// Wall milliseconds of one run until the device has finished.
double wall_milliseconds(Device& device, const std::function<void()>& action);

}  // namespace understory
