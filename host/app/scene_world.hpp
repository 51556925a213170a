// A scene with everything that it names, files of all kinds included.
#pragma once
#include "sim/world.hpp"

namespace understory {

/// build_world, and the environment map that the scene names. Throws Error(invalid_input).
World read_world(const Scene& scene);

}  // namespace understory
