#include "sim/plants/presets.hpp"

#include <algorithm>
#include <numbers>

#include "sim/error.hpp"

namespace understory {
namespace {

// Sway: trunk frequencies from f = 0.0766 + 3.1219 D/H^2 (D in cm at breast height, H in m) and damping of 0.05 to 0.1
// from Moore & Maguire 2004, "Natural sway frequencies and damping ratios of trees" (Trees 18:195), whose regression
// is for conifers; open-grown leafy crowns damp more (James, Haritos & Ades 2006, Am. J. Bot. 93:1522). Branches at 0.7
// to 1.5 Hz and leaves at 3 to 8 Hz as in Tadrist et al. 2018, "Foliage motion under wind" (J. R. Soc. Interface
// 15:20180010) and de Langre 2008, "Effects of wind on plants" (Annu. Rev. Fluid Mech. 40:141).
// {frequency Hz, damping, tip angle at 10 m/s in radians}

constexpr double pi = std::numbers::pi, golden = 2.39996;
constexpr double degrees = pi / 180;

// Open-grown oak: a short stout trunk that dissolves into sinuous boughs, a crown as wide as high, gaps between tufts.
Preset broadleaf() {
  Preset preset{"broadleaf", {}, {{0.32, 0.09, 0.035}, {0.9, 0.1, 0.16}, {4.5, 0.15, 0.5}}};
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
       .turn = golden,
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
       .turn = golden,
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
       .turn = golden,
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

// Norway spruce: one straight stem, whorls a year apart that sag with age and lift their tips, flat sprays of shoots.
Preset conifer() {
  Preset preset{"conifer", {}, {{0.3, 0.07, 0.045}, {1.3, 0.08, 0.1}, {7, 0.2, 0.15}}};
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
       .turn = 2 * pi,
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
                 .turn = pi,
                 .upward = 0.5,
                 .droop = 0.2,
                 .first_level = 1,
                 .start = 0.08};
  return preset;
}

// Lombardy poplar: branches from near the ground, all steep, a narrow flame.
Preset column() {
  Preset preset{"column", {}, {{0.26, 0.07, 0.06}, {1.1, 0.08, 0.1}, {3.5, 0.12, 0.7}}};
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
       .turn = golden,
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
       .turn = golden,
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

// Hazel: many stems arching from one stool, leaves down to the ground.
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
       .turn = golden,
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
       .turn = golden,
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
       .turn = golden,
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
                 .turn = pi,
                 .upward = 0.65,
                 .droop = 0.15,
                 .first_level = 1,
                 .start = 0.15};
  return preset;
}

// Silver birch: a slender stem to the top, ascending branches, and long thin twigs that hang from them.
Preset birch() {
  Preset preset{"birch", {}, {{0.3, 0.08, 0.07}, {0.8, 0.09, 0.24}, {5.5, 0.15, 0.6}}};
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
       .turn = golden,
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
       .turn = golden,
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
       .turn = golden,
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

}  // namespace

const std::vector<Preset>& presets() {
  static const std::vector<Preset> all{broadleaf(), conifer(), column(), shrub(), birch()};
  return all;
}

const Preset& find_preset(const std::string& name) {
  std::string names;
  for (const Preset& preset : presets()) {
    if (preset.name == name) return preset;
    names += (names.empty() ? "" : ", ") + preset.name;
  }
  throw Error(ErrorKind::invalid_input, "generator: '" + name + "' is unknown; allowed: " + names);
}

SpeciesTraits scaled_sway(const SpeciesTraits& traits, double reference_height, double height) {
  const double factor = std::clamp(reference_height / height, 0.1, 10.0);
  SpeciesTraits scaled = traits;
  scaled.trunk.frequency *= factor;
  scaled.branch.frequency *= factor;
  return scaled;
}

}  // namespace understory
