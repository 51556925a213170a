// What occlusion grids cost: baking, and shading by few and many bodies, whatever their and the scene's triangles.
#pragma once
#include "bench/report.hpp"

namespace understory {

/// Adds `grid/...` results at 800x600: `grid/occluders-N/METHOD`, `grid/occluder-triangles-N`, `grid/scene-triangles-N`
/// (device time of the method's pass; every covered fragment lies inside at least four grids, or the result counts as
/// wrong) and `grid/bake-N` (host time; N triangles, 32^3 samples of 256 rays).
void bench_grids(Device& device, const BenchOptions& options, BenchReport& report);

}  // namespace understory
