#include "sim/plants/presets.hpp"

#include <algorithm>

#include "sim/error.hpp"

namespace understory {

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
