// The steps of build_world, one a paragraph of the scene file. Each adds to the same world.
#pragma once
#include <vector>

#include "sim/dynamics.hpp"
#include "sim/grass.hpp"
#include "sim/world.hpp"

namespace understory {

/// Terrain, background owner and the terrain's instance.
void add_terrain(World& world);
/// Prototypes, sway and crown constants of the species that are placed, and every plant.
void add_plants(World& world, Dynamics& dynamics);
/// Blades, their sway, and the cover of the ground.
void add_grass(World& world, Dynamics& dynamics);
/// Prototypes, motion and spheres of the occluders.
void add_occluders(World& world, Dynamics& dynamics);

/// Height of the ground, m; 0 everywhere without terrain, nothing beside the terrain.
GroundHeight ground_of(const World& world);
/// Adds a row to the owner table and tells its number.
std::uint32_t add_owner(World& world, Owner owner);
/// A group that nobody has yet.
std::int32_t next_group(const World& world);

}  // namespace understory
