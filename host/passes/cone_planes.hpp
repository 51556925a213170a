// The cone that occluders leave a fragment: what the passes of occlusion grids hand to the environment's light.
#pragma once
#include "host/opencl/buffer.hpp"

namespace understory {

/// The union of all occluders' cones above the fragment's tangent plane, one element per padded fragment.
struct ConePlanes {
  Buffer<float> axis_x, axis_y, axis_z;  // unit, world axes; anything where the share is 0
  Buffer<float> aperture;                // solid angle as a share of the full sphere, [0, 1]
  Buffer<float> share;                   // of V_c that the cone takes: (1/pi) integral of the cosine, [0, 1]
};

inline ConePlanes allocate_cones(Device& device, std::size_t padded_fragments) {
  const auto plane = [&](const char* name) { return Buffer<float>(device, padded_fragments, name); };
  return {plane("cone axis x"), plane("cone axis y"), plane("cone axis z"), plane("cone aperture"),
          plane("cone share")};
}

}  // namespace understory
