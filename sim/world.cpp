#include "sim/world.hpp"

#include <algorithm>

#include "sim/error.hpp"
#include "sim/plants/species.hpp"
#include "sim/terrain.hpp"
#include "sim/wind.hpp"
#include "sim/world_builder.hpp"

namespace understory {

GroundHeight ground_of(const World& world) {
  if (!world.terrain) return [](glm::dvec2) { return std::optional<double>(0); };
  return [terrain = world.terrain](glm::dvec2 at) { return terrain->surface_at(at); };
}

std::uint32_t add_owner(World& world, Owner owner) {
  world.owners.push_back(std::move(owner));
  return static_cast<std::uint32_t>(world.owners.size() - 1);
}

std::int32_t next_group(const World& world) {
  std::int32_t last = -1;
  for (auto owner = world.owners.rbegin(); owner != world.owners.rend() && last < 0; ++owner) last = owner->group;
  return last + 1;  // groups only ever grow along the table
}

void add_terrain(World& world) {
  add_owner(world, {});
  if (!world.scene.has_terrain) return;
  world.terrain = std::make_shared<const Terrain>(read_terrain(world.scene.terrain));
  world.prototypes.push_back(rigid_prototype("terrain", world.terrain->mesh(), false));
  Instance instance;
  instance.role = Instance::Role::terrain;
  Owner owner;
  owner.surface = SurfaceClass::terrain;
  owner.species = "terrain";
  owner.instance = 0;
  owner.albedo = world.scene.terrain_albedo;
  instance.run_owner.assign(world.prototypes.back().runs.size(), add_owner(world, owner));
  world.instances.push_back(std::move(instance));
}

World build_world(const Scene& scene) {
  World world;
  world.scene = scene;
  world.wind = std::make_shared<const Wind>(scene.wind, scene.seed);
  const auto dynamics = std::make_shared<Dynamics>();
  add_terrain(world);
  add_plants(world, *dynamics);
  add_grass(world, *dynamics);
  add_occluders(world, *dynamics);
  world.dynamics = dynamics;
  return world;
}

}  // namespace understory
