// How long kernels take to build, measured in processes of their own: only a fresh process has an empty cache.
#pragma once
#include "bench/report.hpp"

namespace understory {

/// `understory bench --builds`: prints what time_builds() measures here and now, one JSON object a line.
int print_builds(const BenchOptions& options);

/// Runs `understory bench --builds` twice on a cache of compiled kernels that is empty at first, and notes the times
/// in the report's results. Throws Error(unexpected) with what the process said when it fails.
void add_build_times(const BenchOptions& options, BenchReport& report);

}  // namespace understory
