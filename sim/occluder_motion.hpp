// Where the parts of a moving occluder are at time t: keyframed or recorded motion, over the ground.
#pragma once
#include <vector>

#include "sim/path.hpp"
#include "sim/world.hpp"

namespace understory {

/// Part to scene (relative to the origin), one per OccluderPart of Scene::occluders[occluder]. A part whose last
/// keyframe repeats its first pose, a leg or a wheel, goes on for ever; others repeat if the occluder loops.
std::vector<Transform> occluder_parts_at(const World& world, int occluder, double time);

}  // namespace understory
