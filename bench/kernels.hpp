// Each visibility kernel on its own, beside a kernel that reads the same number of planes and writes one.
#pragma once
#include "bench/report.hpp"

namespace understory {

/// Adds `kernel/METHOD` results and the roofs they are held against to `report`.
void bench_kernels(Device& device, const BenchOptions& options, BenchReport& report);

}  // namespace understory
