// The camera that an EXR header tells, in either of the two conventions found in files.
#pragma once
#include <optional>

#include "viz/exr/image.hpp"

namespace understory {

struct HeaderCamera {
  glm::dmat4 world_to_camera{1};  // as in Frame: column vectors, looks along -z
  bool transposed = false;        // the header held the matrix for column vectors, as pbrt writes it
};

/// From `worldToCamera`; empty when there is none. Throws Error(invalid_input) when it is no rigid transform.
std::optional<HeaderCamera> camera_from_header(const ExrAttributeTable& attributes);

}  // namespace understory
