// Where a scene is judged from: its own camera, and one more that nobody tuned a method for.
#pragma once
#include <vector>

#include "sim/world.hpp"

namespace understory {

/// The scene's camera, then the opposite one: turned half round its target, as far away and as high above the ground.
std::vector<Camera> vantage_cameras(const World& world);

}  // namespace understory
