// The same work done in other ways, in the same run: loops in C++, VTK's screen-space occlusion, traced rays; and how
// fast the traced truth and the bakes of crowns are.
#pragma once
#include "bench/report.hpp"

namespace understory {

/// Adds `peer/...`, `truth/...` and `bake/...` to `report`, on the host's clock.
void bench_peers(Device& device, const BenchOptions& options, BenchReport& report);

}  // namespace understory
