// The generator's species: how each grows and how it sways.
#pragma once
#include <string>
#include <vector>

#include "sim/plants/skeleton.hpp"
#include "sim/plants/species.hpp"

namespace understory {

struct Preset {
  std::string name;
  GrowthTraits growth;
  SpeciesTraits sway;  // of a plant of `growth.height`
};

/// broadleaf, conifer, column, shrub, birch.
const std::vector<Preset>& presets();

/// Throws Error(invalid_input) with the names there are.
const Preset& find_preset(const std::string& name);

/// Sway of a plant `height` metres tall when one of `reference_height` sways like `traits`. Of similar shape, the
/// taller is slower: f ~ diameter / height^2 ~ 1 / height (Moore & Maguire 2004). Leaves keep their own frequency.
SpeciesTraits scaled_sway(const SpeciesTraits& traits, double reference_height, double height);

}  // namespace understory
