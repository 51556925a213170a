#include "sim/plants/species.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "sim/crown.hpp"
#include "sim/error.hpp"
#include "sim/plants/foliage.hpp"
#include "sim/plants/limb_mesh.hpp"
#include "sim/plants/limbs.hpp"
#include "sim/plants/presets.hpp"
#include "sim/random.hpp"

namespace understory {
namespace {

/// Leaf counts beyond this do not fit 32-bit indices with the wood beside them.
constexpr int most_leaves = 200'000'000;

LimbMesh generate(const SpeciesSource& source, const Preset& preset, std::uint64_t seed) {
  if (source.leaves < 0 || source.leaves > most_leaves) {
    throw Error(ErrorKind::invalid_input, "species '" + source.name + "': leaves: " + std::to_string(source.leaves) +
                                              " is out of range; allowed: 0 to " + std::to_string(most_leaves));
  }
  const GrowthTraits& growth = preset.growth;
  const int count = source.leaves > 0 ? source.leaves : growth.leaf.count;
  const double size = std::sqrt(growth.leaf.count / static_cast<double>(count));  // the leaf area stays
  const std::uint64_t plant_seed = mix_bits(seed ^ stream_of(source.name, stream_of(preset.name, source.variant)));
  const std::vector<Stem> stems = grow_skeleton(growth, plant_seed);
  LimbMesh mesh;
  const std::vector<std::uint32_t> limb = make_limbs(mesh, growth, stems, plant_seed);
  add_wood(mesh, growth, stems, limb);
  add_leaves(mesh, growth, stems, limb, count, size, plant_seed);
  return mesh;
}

/// Scales about the root so that the highest vertex comes to `height` m.
void scale_to_height(LimbMesh& mesh, double height, const std::string& name) {
  float top = 0;
  for (glm::vec3 position : mesh.positions) top = std::max(top, position.z);
  if (!(top > 0)) throw Error(ErrorKind::invalid_input, "species '" + name + "': mesh has no height above its root");
  const float factor = static_cast<float>(height) / top;
  for (glm::vec3& position : mesh.positions) position *= factor;
  for (glm::vec3& flutter : mesh.flutter) flutter *= factor;
  for (Limb& limb : mesh.limbs) {
    limb.base *= factor;
    limb.length *= factor;
    limb.reach *= factor;
  }
}

}  // namespace

Species build_species(const SpeciesSource& source, std::uint64_t seed, const RawMesh* mesh) {
  // A mesh sways like a broadleaf of its height unless the scene says otherwise.
  const Preset& preset = find_preset(mesh != nullptr ? "broadleaf" : source.generator);
  LimbMesh shape = mesh != nullptr ? limbs_from_mesh(*mesh, seed) : generate(source, preset, seed);
  if (mesh == nullptr || source.height > 0) {
    scale_to_height(shape, source.height > 0 ? source.height : preset.growth.height, source.name);
  }
  measure_reach(shape);

  Species species;
  species.prototype = assemble(source.name, shape);
  species.prototype.crown = fit_crown(species.prototype, source.shells);
  const SpeciesTraits sway = scaled_sway(preset.sway, preset.growth.height, species.prototype.high.z);
  species.trunk = source.trunk.value_or(sway.trunk);
  species.branch = source.branch.value_or(sway.branch);
  species.leaf = source.leaf.value_or(sway.leaf);

  const CrownConstants constants = derive_constants(species.prototype, source.reeves_blau_ambient);
  const auto given_or = [](double given, double derived) { return static_cast<float>(given >= 0 ? given : derived); };
  species.alpha_rho = given_or(source.alpha_rho, constants.alpha_rho);
  species.alpha_rho_ellipsoid = given_or(source.alpha_rho, constants.alpha_rho_ellipsoid);
  species.alpha_rho_shells = given_or(source.alpha_rho, constants.alpha_rho_shells);
  species.extinction = static_cast<float>(constants.extinction);
  species.reeves_blau_extinction = given_or(source.reeves_blau_extinction, constants.reeves_blau_extinction);
  species.opacity = static_cast<float>(constants.opacity);
  return species;
}

Prototype rigid_prototype(const std::string& name, const RawMesh& mesh, bool limb_per_part) {
  LimbMesh shape;
  std::map<std::string, std::uint32_t> limb_of_name;
  for (const RawMesh::Part& part : mesh.parts) {
    const auto [entry, is_new] =
        limb_of_name.try_emplace(limb_per_part ? part.name : "", static_cast<std::uint32_t>(shape.limbs.size()));
    if (is_new) shape.limbs.push_back({});
    const std::uint32_t offset = static_cast<std::uint32_t>(shape.positions.size());
    for (glm::vec3 position : part.positions) shape.add_vertex(position, entry->second);
    std::vector<std::uint32_t>& triangles = shape.triangles[part.surface];
    for (std::uint32_t index : part.triangles) triangles.push_back(offset + index);
  }
  return assemble(name, shape);
}

}  // namespace understory
