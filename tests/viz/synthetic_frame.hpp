// Frames without a renderer: a meadow plane, two balls as trees and a row of blades, cast ray by ray in closed form.
#pragma once
#include "sim/frame.hpp"

namespace understory {

/// Plane z = 0 (owner 1, terrain), ball of 2 m at (-3, 8, 2.5) (owner 2, leaf), ball of 1 m at (2.5 + sin(time), 6, 1)
/// (owner 3, occluder), upright blades y = 3, |x| < 3, z < 0.5 (owner 4), sky (owner 0). The camera stands at
/// (0.3, -4, 1.7) and looks at (0, 6, 1.5). Visibility: (1 + n_z)/2 times what the balls leave.
Frame synthetic_frame(int width, int height, double time = 0);

}  // namespace understory
