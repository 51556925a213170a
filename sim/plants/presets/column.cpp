// Lombardy poplar: branches from near the ground, all steep, a narrow flame.
#include "sim/plants/presets.hpp"

namespace understory {

Preset column() {
  Preset preset{"column", {}, {{0.42, 0.07, 0.06}, {1.1, 0.08, 0.1}, {3.5, 0.12, 0.7}}};
  GrowthTraits& growth = preset.growth;
  growth.height = 22;
  growth.outline = {0.7, 1, 1, 0.9, 0.75, 0.45};
  growth.levels = {
      {.length = 0.95,
       .length_spread = 0.01,
       .wander = 0.07,
       .slenderness = 0.0145,
       .taper = 0.9,
       .segments = 14,
       .sides = 10},
      {.spacing = 0.0075,
       .bare = 0.06,
       .length = 0.225,
       .length_spread = 0.15,
       .angle_base = 34 * degrees,
       .angle_tip = 20 * degrees,
       .angle_spread = 0.08,
       .turn = golden_angle,
       .tropism_base = 1.4,
       .tropism_tip = 0.7,
       .wander = 0.2,
       .slenderness = 0.0085,
       .segments = 6,
       .sides = 5},
      {.spacing = 0.011,
       .bare = 0.12,
       .length = 0.36,
       .length_spread = 0.3,
       .angle_base = 38 * degrees,
       .angle_tip = 26 * degrees,
       .angle_spread = 0.15,
       .turn = golden_angle,
       .tropism_base = 0.8,
       .tropism_tip = 0.6,
       .wander = 0.3,
       .slenderness = 0.008,
       .segments = 3,
       .sides = 3},
  };
  growth.root_flare = 0.8;
  growth.leaf = {.count = 110'000,
                 .length = 0.075,
                 .width = 0.95,
                 .widest = 0.38,
                 .fold = 0.15,
                 .petiole = 0.55,
                 .angle = 1.05,
                 .turn = 144 * degrees,
                 .upward = 0.25,
                 .droop = 0.35,
                 .first_level = 2,
                 .start = 0.05};
  return preset;
}

}  // namespace understory
