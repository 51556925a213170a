// The world of a scene with the constants of its crown models calibrated where a planned method reads them.
#pragma once
#include <string>
#include <vector>

#include "sim/world.hpp"

namespace understory {

/// True when a method of `methods` reads calibrated constants.
bool reads_calibration(const Methods& methods);

/// Sets the constants of every species that stands in the world with a crown: from the cache of bakes where it knows
/// this very geometry, else calibrated and kept there. What the scene file gives itself stays. Returns the names of the
/// species that had to be calibrated.
std::vector<std::string> calibrate_world(World& world);

}  // namespace understory
