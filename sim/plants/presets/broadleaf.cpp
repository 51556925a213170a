// Open-grown oak: a short stout trunk that dissolves into sinuous boughs, a crown as wide as high, gaps between tufts.
#include "sim/plants/presets.hpp"

namespace understory {

Preset broadleaf() {
  Preset preset{"broadleaf", {}, {{0.4, 0.09, 0.035}, {0.9, 0.1, 0.16}, {4.5, 0.15, 0.5}}};
  GrowthTraits& growth = preset.growth;
  growth.height = 14;
  growth.outline = {0.68, 0.92, 1, 0.95, 0.82, 0.6};
  growth.levels = {
      {.length = 0.72,
       .length_spread = 0.02,
       .wander = 0.25,
       .slenderness = 0.034,
       .taper = 0.85,
       .segments = 10,
       .sides = 12},
      {.spacing = 0.02,
       .bare = 0.25,
       .length = 0.47,
       .length_spread = 0.13,
       .angle_base = 80 * degrees,
       .angle_tip = 32 * degrees,
       .angle_spread = 0.14,
       .turn = golden_angle,
       .tropism_base = 0.4,
       .tropism_tip = 0.4,
       .wander = 0.45,
       .slenderness = 0.022,
       .taper = 0.8,
       .segments = 8,
       .sides = 7},
      {.spacing = 0.019,
       .bare = 0.22,
       .length = 0.52,
       .length_spread = 0.3,
       .angle_base = 60 * degrees,
       .angle_tip = 42 * degrees,
       .angle_spread = 0.25,
       .turn = golden_angle,
       .tropism_base = 0.25,
       .tropism_tip = 0.3,
       .wander = 0.7,
       .slenderness = 0.016,
       .segments = 5,
       .sides = 4},
      {.spacing = 0.0095,
       .bare = 0.2,
       .length = 0.42,
       .length_spread = 0.35,
       .angle_base = 60 * degrees,
       .angle_tip = 40 * degrees,
       .angle_spread = 0.3,
       .turn = golden_angle,
       .tropism_base = 0.3,
       .tropism_tip = 0.3,
       .wander = 0.6,
       .slenderness = 0.012,
       .segments = 2,
       .sides = 3},
  };
  growth.root_flare = 0.6;
  growth.leaf = {.count = 140'000,
                 .length = 0.115,
                 .width = 0.58,
                 .widest = 0.58,
                 .fold = 0.25,
                 .petiole = 0.08,
                 .angle = 0.95,
                 .turn = 144 * degrees,
                 .upward = 0.55,
                 .droop = 0.1,
                 .first_level = 3,
                 .start = 0.25};
  return preset;
}

}  // namespace understory
