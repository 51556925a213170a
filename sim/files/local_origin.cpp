#include "sim/files/local_origin.hpp"

#include <algorithm>
#include <cmath>

namespace understory {
namespace {

constexpr double nearby = 1e4, step = 1e3;  // m

void move(glm::dvec3& position, glm::dvec2 to) {
  position.x -= to.x;
  position.y -= to.y;
}

void move(Region& region, glm::dvec2 to) {
  region.low -= to;
  region.high -= to;
}

}  // namespace

void move_zero(Scene& scene, glm::dvec2 to) {
  scene.origin += glm::dvec3(to, 0);
  move(scene.camera.position, to);
  move(scene.camera.target, to);
  move(scene.terrain.extent, to);
  scene.terrain.centre -= to;
  for (PlantPlacement& plants : scene.plants) {
    for (PlantPlacement::Spot& spot : plants.spots) spot.at -= to;
    move(plants.region, to);
  }
  for (GrassField& field : scene.grass) move(field.region, to);
  for (OccluderSource& occluder : scene.occluders) {
    if (occluder.keyframes.empty()) occluder.keyframes.push_back({0, glm::dvec3(0), glm::dvec3(0)});
    for (Keyframe& frame : occluder.keyframes) move(frame.position, to);
  }
}

glm::dvec2 local_zero(const Scene& scene) {
  const glm::dvec2 eye(scene.camera.position);
  if (std::max(std::abs(eye.x), std::abs(eye.y)) <= nearby) return glm::dvec2(0);
  return step * glm::round(eye / step);
}

}  // namespace understory
