#include "sim/vantage.hpp"

#include <algorithm>

#include "sim/terrain.hpp"

namespace understory {
namespace {

constexpr double least_height = 0.3;  // m above the ground, wherever the scene's own camera is

double ground_at(const World& world, glm::dvec3 position) {
  return world.terrain ? world.terrain->height_at(glm::dvec2(position)) : 0.0;
}

}  // namespace

std::vector<Camera> vantage_cameras(const World& world) {
  const Camera& own = world.scene.camera;
  Camera opposite = own;
  opposite.position.x = 2 * own.target.x - own.position.x;
  opposite.position.y = 2 * own.target.y - own.position.y;
  const double height = own.position.z - ground_at(world, own.position);
  opposite.position.z = ground_at(world, opposite.position) + std::max(height, least_height);
  return {own, opposite};
}

}  // namespace understory
