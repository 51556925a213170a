// The scene's camera as kernels, EXR headers and windows need it.
#pragma once
#include <glm/glm.hpp>

#include "kernels/shared/records.h"
#include "sim/scene.hpp"

namespace understory {

/// `pixel_offset` moves the sample inside every pixel, pixels in [-0.5, 0.5].
CameraView camera_view(const Camera& camera, const ImageSize& image, glm::dvec2 pixel_offset);

/// Positions relative to the origin to camera space, column vectors; the camera looks along -z with y up.
glm::dmat4 world_to_camera(const Camera& camera);

}  // namespace understory
