#include "sim/occluder_motion.hpp"

#include <cmath>

#include "sim/dynamics.hpp"
#include "sim/terrain.hpp"

namespace understory {
namespace {

bool is_cycle(const std::vector<Keyframe>& keyframes) {
  if (keyframes.size() < 2) return false;
  const Transform first = transform_of(keyframes.front()), last = transform_of(keyframes.back());
  return glm::distance(first.translation, last.translation) < 1e-6 &&
         std::abs(glm::dot(first.rotation, last.rotation)) > 1 - 1e-9;
}

}  // namespace

std::vector<Transform> occluder_parts_at(const World& world, int occluder, double time) {
  const OccluderSource& source = world.scene.occluders[occluder];
  const MotionRecord& record = world.dynamics->records[occluder];
  Transform body = path_at(source.keyframes, source.loop, time);
  if (source.on_terrain && world.terrain) body.translation.z += world.terrain->height_at(glm::dvec2(body.translation));
  std::vector<Transform> parts;
  for (const OccluderPart& part : source.parts) {
    const bool repeats = source.loop || is_cycle(part.keyframes);
    parts.push_back(body *
                    (record.find(part.name) ? record.at(part.name, time) : path_at(part.keyframes, repeats, time)));
  }
  return parts;
}

}  // namespace understory
