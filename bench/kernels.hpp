// Each kernel on its own, at several sizes, beside what the device can do at most.
#pragma once
#include "bench/report.hpp"

namespace understory {

/// Adds `kernel/NAME` results and the roofs they are held against to `report`.
void bench_kernels(Device& device, const BenchOptions& options, BenchReport& report);

}  // namespace understory
