// Whole frames of scenes, cold and warm, pass by pass.
#pragma once
#include "bench/report.hpp"

namespace understory {

/// Adds to `report`, for each of options.scenes: `frame/SCENE` (an item is a frame), `frame/SCENE/visibility` (all
/// passes after the resolve; an item is a covered fragment) and `frame/SCENE/PASS`.
void bench_frames(Device& device, const BenchOptions& options, BenchReport& report);

}  // namespace understory
