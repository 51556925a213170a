// Scenes written in plain large coordinates, UTM say: floats keep 0.5 m at 5,000 km, so the zero moves near the camera.
#pragma once
#include <glm/glm.hpp>

#include "sim/scene.hpp"

namespace understory {

/// The same scene with its zero `to` (x and y relative to the present zero, m): positions change by -to, the origin by
/// +to, so that every place in the world stays.
void move_zero(Scene& scene, glm::dvec2 to);

/// Where load_scene puts the zero: the whole kilometre nearest to the camera when the camera is more than 10 km from
/// the present zero along x or y, else (0, 0). Whole kilometres, so that coordinates stay readable.
glm::dvec2 local_zero(const Scene& scene);

}  // namespace understory
