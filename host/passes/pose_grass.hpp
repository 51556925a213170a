// kernels/pose_grass.cl: the blades of one field, bent in the wind of time t.
#pragma once
#include <array>

#include "host/opencl/kernel.hpp"
#include "host/passes/geometry.hpp"

namespace understory {

/// The sway series of a field: (along, across) pairs, radians at flexibility 1, a power of two of them.
using SwaySeries = Buffer<std::array<float, 2>>;

class PoseGrassPass {
 public:
  explicit PoseGrassPass(Device& device);
  /// Poses `blades` blades (a multiple of 256) from `first_blade` on into `posed` from `first_vertex` on.
  void run(const RestBlades& rest, const GrassWind& wind, const SwaySeries& series, std::uint32_t first_blade,
           std::uint32_t blades, std::uint32_t first_vertex, PosedVertices& posed);

 private:
  std::size_t lanes_;
  Kernel kernel_;
};

}  // namespace understory
