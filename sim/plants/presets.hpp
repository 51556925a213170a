// The generator's species: how each grows and how it sways.
#pragma once
#include <numbers>
#include <string>
#include <vector>

#include "sim/plants/skeleton.hpp"
#include "sim/plants/species.hpp"

namespace understory {

inline constexpr double golden_angle = 2.39996;  // radians between leaves that never shade each other exactly
inline constexpr double degrees = std::numbers::pi / 180;

struct Preset {
  std::string name;
  GrowthTraits growth;
  SpeciesTraits sway;  // of a plant of `growth.height`
};

// Sway as {frequency Hz, damping ratio, tip angle in radians at 10 m/s}. Trunks: f = 0.0766 + 3.1219 D/H^2 (D in cm at
// breast height, H in m) and damping of 0.05 to 0.1 from Moore & Maguire 2004, "Natural sway frequencies and damping
// ratios of trees" (Trees 18:195); their regression is for conifers, and the heavy crowns of open-grown broadleaves are
// put below it, with more damping (James, Haritos & Ades 2006, Am. J. Bot. 93:1522). Branches at 0.7 to 1.5 Hz and
// leaves at 3 to 8 Hz: Tadrist et al. 2018, "Foliage motion under wind" (J. R. Soc. Interface 15:20180010) and de
// Langre 2008, "Effects of wind on plants" (Annu. Rev. Fluid Mech. 40:141).
Preset broadleaf();
Preset conifer();
Preset column();
Preset shrub();
Preset birch();

/// All of them, in this order.
const std::vector<Preset>& presets();

/// Throws Error(invalid_input) with the names there are.
const Preset& find_preset(const std::string& name);

/// Sway of a plant `height` metres tall when one of `reference_height` sways like `traits`. Of similar shape, the
/// taller is slower: f ~ diameter / height^2 ~ 1 / height (Moore & Maguire 2004). Leaves keep their own frequency.
SpeciesTraits scaled_sway(const SpeciesTraits& traits, double reference_height, double height);

}  // namespace understory
