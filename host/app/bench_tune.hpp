// `understory bench --tune`: measures how passes are launched best on a device and saves it for all commands.
#pragma once
#include "bench/report.hpp"

namespace understory {

/// Prints what was found. Throws Error(usage) when there is no place for the table.
int bench_tune(const BenchOptions& options);

}  // namespace understory
