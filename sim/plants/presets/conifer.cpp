// Norway spruce: one straight stem, whorls a year apart that sag with age and lift their tips, flat sprays of shoots.
#include "sim/plants/presets.hpp"

namespace understory {

Preset conifer() {
  Preset preset{"conifer", {}, {{0.45, 0.07, 0.045}, {1.3, 0.08, 0.1}, {7, 0.2, 0.15}}};
  GrowthTraits& growth = preset.growth;
  growth.height = 18;
  growth.outline = {0.95, 1, 0.8, 0.58, 0.35, 0.1};
  growth.levels = {
      {.length = 1,
       .length_spread = 0,
       .wander = 0.03,
       .slenderness = 0.0115,
       .taper = 0.95,
       .segments = 16,
       .sides = 10},
      {.spacing = 0.028,
       .per_node = 6,
       .bare = 0.05,
       .length = 0.18,
       .length_spread = 0.14,
       .angle_base = 108 * degrees,
       .angle_tip = 48 * degrees,
       .angle_spread = 0.1,
       .turn = 0.5,
       .turn_spread = 0.22,
       .tropism_base = -0.2,
       .tropism_tip = 0.85,
       .wander = 0.16,
       .slenderness = 0.009,
       .segments = 6,
       .sides = 5},
      {.spacing = 0.0085,
       .per_node = 2,
       .bare = 0.08,
       .length = 0.36,
       .length_spread = 0.2,
       .angle_base = 62 * degrees,
       .angle_tip = 45 * degrees,
       .angle_spread = 0.12,
       .turn = 360 * degrees,
       .turn_spread = 0.35,
       .tropism_base = -0.6,
       .tropism_tip = -0.5,
       .wander = 0.15,
       .slenderness = 0.006,
       .segments = 3,
       .sides = 3},
  };
  growth.root_flare = 0.4;
  // A leaf stands for a short shoot with its needles.
  growth.leaf = {.count = 120'000,
                 .length = 0.165,
                 .width = 0.28,
                 .widest = 0.5,
                 .fold = 0.3,
                 .petiole = 0.0,
                 .angle = 0.7,
                 .turn = 180 * degrees,
                 .upward = 0.5,
                 .droop = 0.2,
                 .first_level = 1,
                 .start = 0.08};
  return preset;
}

}  // namespace understory
