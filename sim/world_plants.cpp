// Plants of a scene: the species that are placed, and every individual with its owners and crown.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "sim/crown.hpp"
#include "sim/error.hpp"
#include "sim/files/mesh.hpp"
#include "sim/placement.hpp"
#include "sim/plants/species.hpp"
#include "sim/random.hpp"
#include "sim/world_builder.hpp"

namespace understory {
namespace {

/// Leaves in gusts: they follow the wind's pressure within about a second, without ringing.
constexpr double flutter_build_up = 1;  // Hz
constexpr double flutter_damping = 1;   // ratio to critical

std::size_t species_index(const Scene& scene, const PlantPlacement& placement) {
  for (std::size_t i = 0; i < scene.species.size(); ++i)
    if (scene.species[i].name == placement.species) return i;
  throw Error(ErrorKind::invalid_input,
              "plants: species `" + placement.species + "` is not in the list of species of " + scene.file.string());
}

Species build(const SpeciesSource& source, std::uint64_t seed) {
  if (source.mesh.empty()) return build_species(source, seed, nullptr);
  const RawMesh mesh = read_mesh(source.mesh, source.up, source.leaf_materials, source.blade_materials);
  return build_species(source, seed, &mesh);
}

SpeciesSway sway_of(const Species& species, const Wind& wind) {
  const Prototype& prototype = species.prototype;
  const double crown_height =
      prototype.crown.sphere_radius > 0 ? prototype.crown.sphere_centre.z : prototype.high.z / 2;
  SpeciesSway sway;
  sway.trunk = wind.respond(species.trunk, crown_height);
  sway.branch = wind.respond(species.branch, crown_height);
  sway.flutter = wind.respond({flutter_build_up, flutter_damping, species.leaf.deflection}, crown_height);
  sway.leaf_frequency = species.leaf.frequency;
  const double crown_speed = wind.mean_speed(crown_height);
  for (const Limb& limb : prototype.limbs) {
    // The trunk's series answers the load of the whole crown; a branch answers the wind where it is.
    const double height = double(limb.base.z) + double(limb.axis.z) * double(limb.length) / 2;
    const double share = crown_speed > 0 ? wind.mean_speed(height) / crown_speed : 1;
    sway.exposure.push_back(limb.kind == SwayKind::branch ? share * share : 1);
  }
  return sway;
}

CrownModel crown_model_of(const Species& species, const SpeciesSource& source) {
  CrownModel model;
  model.alpha_rho = species.alpha_rho;
  model.alpha_rho_ellipsoid = species.alpha_rho_ellipsoid;
  model.alpha_rho_shells = species.alpha_rho_shells;
  model.alpha_rho_levels = species.alpha_rho_shells / 2;  // two levels share what one blocks
  model.extinction = species.extinction;
  for (const glm::vec4& shell : species.prototype.crown.shells)
    model.shell_opacity.push_back(static_cast<float>(1 - disc_transmittance(double(shell.w * species.extinction))));
  model.reeves_blau_ambient = static_cast<float>(source.reeves_blau_ambient);
  model.reeves_blau_extinction = species.reeves_blau_extinction;
  model.opacity = species.opacity;
  return model;
}

/// The owners of a plant's surfaces: leaf and wood apart, crown and group shared.
std::vector<std::uint32_t> add_owners(World& world, const Prototype& prototype, const SpeciesSource& source,
                                      std::int32_t crown) {
  const std::int32_t group = next_group(world);
  std::map<SurfaceClass, std::uint32_t> row;
  std::vector<std::uint32_t> run_owner;
  for (const TriangleRun& run : prototype.runs) {
    if (!row.contains(run.surface)) {
      Owner owner;
      owner.surface = run.surface;
      owner.species = source.name;
      owner.instance = static_cast<std::int32_t>(world.instances.size());
      owner.albedo = run.surface == SurfaceClass::wood ? source.wood_albedo : source.leaf_albedo;
      owner.crown = crown;
      owner.group = group;
      row[run.surface] = add_owner(world, owner);
    }
    run_owner.push_back(row[run.surface]);
  }
  return run_owner;
}

}  // namespace

void add_plants(World& world, Dynamics& dynamics) {
  const Scene& scene = world.scene;
  std::vector<std::vector<const PlantPlacement*>> placements(scene.species.size());
  for (const PlantPlacement& placement : scene.plants)
    placements[species_index(scene, placement)].push_back(&placement);

  std::vector<std::optional<Species>> built(scene.species.size());
  tbb::parallel_for(std::size_t(0), built.size(), [&](std::size_t i) {
    if (!placements[i].empty()) built[i] = build(scene.species[i], scene.seed);
  });

  const GroundHeight ground = ground_of(world);
  const Admissible admissible = [&](glm::dvec2 at) { return ground(at).has_value(); };
  dynamics.species.resize(scene.species.size());
  world.crown_models.resize(scene.species.size());
  std::int32_t crowns = 0;
  for (std::size_t i = 0; i < built.size(); ++i) {
    if (!built[i]) continue;
    const SpeciesSource& source = scene.species[i];
    dynamics.species[i] = sway_of(*built[i], *world.wind);
    world.crown_models[i] = crown_model_of(*built[i], source);
    world.prototypes.push_back(std::move(built[i]->prototype));
    const Prototype& prototype = world.prototypes.back();
    for (std::size_t ordinal = 0; ordinal < placements[i].size(); ++ordinal)
      for (const PlacedPlant& plant :
           place(*placements[i][ordinal], scene.seed, stream_of(source.name, ordinal), admissible)) {
        Instance instance;
        instance.prototype = static_cast<std::uint32_t>(world.prototypes.size() - 1);
        instance.species = static_cast<std::int32_t>(i);
        instance.position = {plant.at, *ground(plant.at)};
        instance.yaw = plant.yaw;
        instance.scale = plant.scale;
        instance.delay = plant.delay;
        instance.crown = prototype.crown.sphere_radius > 0 ? crowns++ : -1;
        instance.run_owner = add_owners(world, prototype, source, instance.crown);
        world.instances.push_back(std::move(instance));
      }
  }
}

}  // namespace understory
