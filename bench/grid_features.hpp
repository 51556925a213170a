// What each feature of moving occluders costs on the eleven-part walker: Malmer et al. 2005, figure 16.
#pragma once
#include "bench/report.hpp"

namespace understory {

/// Adds `grid/feature/FEATURE` at 800 x 600: device time of the occluders' pass and of the environment's light, the
/// walker filling the picture's height. By turns, so that load falls on all alike.
void bench_grid_features(Device& device, const BenchOptions& options, BenchReport& report);

}  // namespace understory
