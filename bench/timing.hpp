// Repeated measurements of things that run on a device, taken in turn so that drift of the machine meets all alike.
// (Google Benchmark runs one after the other: a ratio of two of its figures holds the drift between them.)
#pragma once
#include <cstddef>
#include <functional>
#include <vector>

#include "host/opencl/device.hpp"

namespace understory {

/// Milliseconds. The interval holds the true median with 95 % confidence (order statistics).
struct Spread95 {
  double median = 0, low = 0, high = 0;
};

/// Throws Error(unexpected) for no samples.
Spread95 spread_of(std::vector<double> samples);

struct MeasuredTime {
  Spread95 device_ms;  // sum over the launches, from the device's own clock
  Spread95 wall_ms;    // from the first call to the last result, on the host
};

/// Runs all `actions` once each, `repetitions` times over, forwards and backwards by turns, after one untimed round.
std::vector<MeasuredTime> time_in_turn(Device& device, const std::vector<std::function<void()>>& actions,
                                       int repetitions);

/// Wall milliseconds of one run until the device has finished.
double wall_milliseconds(Device& device, const std::function<void()>& action);

}  // namespace understory
