// Hazel: many stems arching from one stool, leaves down to the ground.
#include "sim/plants/presets.hpp"

namespace understory {

Preset shrub() {
  Preset preset{"shrub", {}, {{1.0, 0.1, 0.12}, {1.5, 0.1, 0.2}, {5, 0.15, 0.5}}};
  GrowthTraits& growth = preset.growth;
  growth.height = 3;
  growth.outline = {0.9, 1, 1, 0.9, 0.75, 0.5};
  growth.levels = {
      {.per_node = 15,
       .length = 0.98,
       .length_spread = 0.08,
       .angle_base = 42 * degrees,
       .turn = golden_angle,
       .turn_spread = 0.4,
       .tropism_base = 0.35,
       .tropism_tip = -0.6,
       .wander = 0.3,
       .slenderness = 0.0085,
       .segments = 8,
       .sides = 6},
      {.spacing = 0.06,
       .bare = 0.07,
       .length = 0.34,
       .length_spread = 0.25,
       .angle_base = 65 * degrees,
       .angle_tip = 38 * degrees,
       .angle_spread = 0.25,
       .turn = golden_angle,
       .tropism_base = 0.3,
       .tropism_tip = 0.1,
       .wander = 0.4,
       .slenderness = 0.009,
       .segments = 4,
       .sides = 4},
      {.spacing = 0.026,
       .bare = 0.1,
       .length = 0.5,
       .length_spread = 0.3,
       .angle_base = 55 * degrees,
       .angle_tip = 40 * degrees,
       .angle_spread = 0.25,
       .turn = golden_angle,
       .tropism_base = 0.2,
       .tropism_tip = 0.1,
       .wander = 0.4,
       .slenderness = 0.009,
       .segments = 2,
       .sides = 3},
  };
  growth.root_flare = 0.1;
  growth.leaf = {.count = 24'000,
                 .length = 0.08,
                 .width = 0.8,
                 .widest = 0.55,
                 .fold = 0.2,
                 .petiole = 0.15,
                 .angle = 1.0,
                 .turn = 180 * degrees,
                 .upward = 0.65,
                 .droop = 0.15,
                 .first_level = 1,
                 .start = 0.15};
  return preset;
}

}  // namespace understory
