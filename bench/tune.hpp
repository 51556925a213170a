// The fastest way to launch each pass on a device: fragments per work-item and per work-group, measured beside the
// built-in shape.
#pragma once
#include "bench/report.hpp"

namespace understory {

struct TunedPass {
  std::string pass;
  LaunchShape shape;               // {0, 0}: the built-in shape is as fast as any
  double ms = 0, built_in_ms = 0;  // medians of the last, direct comparison
};

/// Passes that the filter lets through (as kernel/NAME), on options.fragments.front() fragments. A shape counts as
/// faster when a second comparison of it with the built-in one, by turns, says so beyond both intervals.
std::vector<TunedPass> tune_passes(const BenchOptions& options);

/// The table of host/opencl/tuning.hpp with these rows and with `kept`, what an earlier table says of other passes.
std::string tuning_text(const DeviceInfo& device, const std::vector<TunedPass>& passes, const TuningTable& kept);

}  // namespace understory
