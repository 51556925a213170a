// Whether what is drawn already hides a sphere: occlusion culling within the frame. Conservative: it may keep what
// nobody sees, it never drops what somebody does.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "kernels/shared/records.h"

namespace understory {

/// Of a frame that `camera` sees, as far as it is drawn.
struct DrawnDepth {
  CameraView camera{};
  std::vector<float> farthest;  // per tile, m ahead (host/passes/farthest_depth.hpp); empty: nothing is drawn
  /// Whether any tile is covered whole, so that it can hide something.
  bool hides() const;
};

/// Whether every pixel that the sphere (camera-relative m) may fall on shows something nearer than all of it.
bool is_hidden(const DrawnDepth& drawn, const glm::dvec3& centre, double radius);

}  // namespace understory
