// A scene with everything that it names, files of all kinds included.
#pragma once
#include "sim/world.hpp"

namespace understory {

/// build_world, the environment map that the scene names, and the crown models' constants, calibrated where a planned
/// method reads them, or for `all_methods`: whatever the scene's own are, others may come. Throws Error(invalid_input).
World read_world(const Scene& scene, bool all_methods = false);

}  // namespace understory
