// Grass of a scene: no blade grows out of a trunk.
#include <algorithm>
#include <cmath>

#include "sim/grass_wind.hpp"
#include "sim/world_builder.hpp"

namespace understory {
namespace {

constexpr float foot_height = 0.15f;  // m: wood below this keeps grass away
constexpr float widest_foot = 1.5f;   // m: what reaches further is a branch that lies on the ground

/// Radius of the wood just above ground, m, in rest pose.
float foot_radius(const Prototype& prototype) {
  float square = 0;
  for (const TriangleRun& run : prototype.runs) {
    if (run.surface != SurfaceClass::wood) continue;
    for (std::uint32_t index = 3 * run.first; index < 3 * (run.first + run.count); ++index) {
      const std::uint32_t vertex = prototype.triangles[index];
      const float x = prototype.vertices.x[vertex], y = prototype.vertices.y[vertex];
      if (prototype.vertices.z[vertex] < foot_height) square = std::max(square, x * x + y * y);
    }
  }
  return std::min(std::sqrt(square), widest_foot);
}

}  // namespace

void add_grass(World& world, Dynamics& dynamics) {
  if (world.scene.grass.empty()) return;
  std::vector<float> radius;
  for (const Prototype& prototype : world.prototypes) radius.push_back(foot_radius(prototype));
  std::vector<Disc> bare;
  for (const Instance& instance : world.instances)
    if (instance.role == Instance::Role::plant)
      bare.push_back({glm::dvec2(instance.position), instance.scale * radius[instance.prototype]});

  for (std::uint32_t f = 0; f < world.scene.grass.size(); ++f) {
    const GrassField& field = world.scene.grass[f];
    GrassBlades blades = grow_grass(field, f, world.scene.seed, ground_of(world), bare);
    Owner owner;
    owner.surface = SurfaceClass::blade;
    owner.species = "grass." + std::to_string(f);
    owner.instance = static_cast<std::int32_t>(f);
    owner.albedo = field.albedo;
    blades.owner = add_owner(world, owner);
    world.grass.push_back(std::move(blades));
    dynamics.grass.push_back(grass_response(*world.wind, field));
  }
  world.ground_cover = cover_ground(world.grass);
}

}  // namespace understory
