// Silver birch: a slender stem to the top, ascending branches, and long thin twigs that hang from them.
#include "sim/plants/presets.hpp"

namespace understory {

Preset birch() {
  Preset preset{"birch", {}, {{0.4, 0.08, 0.07}, {0.8, 0.09, 0.24}, {5.5, 0.15, 0.6}}};
  GrowthTraits& growth = preset.growth;
  growth.height = 16;
  growth.outline = {0.75, 1, 1, 0.85, 0.62, 0.35};
  growth.levels = {
      {.length = 0.96,
       .length_spread = 0.02,
       .wander = 0.16,
       .slenderness = 0.0095,
       .taper = 0.9,
       .segments = 14,
       .sides = 9},
      {.spacing = 0.0145,
       .bare = 0.18,
       .length = 0.3,
       .length_spread = 0.15,
       .angle_base = 62 * degrees,
       .angle_tip = 32 * degrees,
       .angle_spread = 0.14,
       .turn = golden_angle,
       .tropism_base = 0.7,
       .tropism_tip = -1.1,
       .wander = 0.3,
       .slenderness = 0.009,
       .segments = 8,
       .sides = 5},
      {.spacing = 0.02,
       .bare = 0.2,
       .length = 0.42,
       .length_spread = 0.3,
       .angle_base = 55 * degrees,
       .angle_tip = 42 * degrees,
       .angle_spread = 0.2,
       .turn = golden_angle,
       .tropism_base = 0.1,
       .tropism_tip = -2.2,
       .wander = 0.3,
       .slenderness = 0.006,
       .segments = 4,
       .sides = 3},
      {.spacing = 0.0105,
       .bare = 0.2,
       .length = 0.85,
       .length_spread = 0.4,
       .angle_base = 60 * degrees,
       .angle_tip = 40 * degrees,
       .angle_spread = 0.25,
       .turn = golden_angle,
       .tropism_base = -2.6,
       .tropism_tip = -3.2,
       .wander = 0.2,
       .slenderness = 0.003,
       .segments = 4,
       .sides = 3},
  };
  growth.root_flare = 0.5;
  growth.leaf = {.count = 120'000,
                 .length = 0.06,
                 .width = 0.78,
                 .widest = 0.38,
                 .fold = 0.15,
                 .petiole = 0.35,
                 .angle = 0.95,
                 .turn = 144 * degrees,
                 .upward = 0.3,
                 .droop = 0.4,
                 .first_level = 3,
                 .start = 0.05};
  return preset;
}

}  // namespace understory
