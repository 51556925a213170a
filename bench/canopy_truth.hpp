// Ground under an endless random canopy of spherical leaf angles: V_c = 2 E3(LAI/2) on average (FORMULAS.md). Exact for
// leaves of any size that are strewn independently: a ray meets a Poisson number of them.
#pragma once
#include <cstdint>

namespace understory {

struct CanopyTruth {
  double leaf_area_index = 0;
  double traced = 0, standard_error = 0;  // V_c over the realisations
  double closed_form = 0;                 // 2 E3(LAI/2)
};

/// Traces 64 points of level ground in the middle of each of `realisations` (at least 2) canopies, 14 m wide and 1 m
/// thick, of leaves of 1 dm^2: their edge stands 8 degrees above the horizon, where next to no light comes from.
CanopyTruth trace_canopy(double leaf_area_index, int realisations, int rays);

}  // namespace understory
