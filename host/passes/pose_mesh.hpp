// kernels/pose_mesh.cl: rest vertices of plants, occluders and terrain to where they are at time t.
#pragma once
#include "host/opencl/kernel.hpp"
#include "host/passes/geometry.hpp"

namespace understory {

class PoseMeshPass {
 public:
  explicit PoseMeshPass(Device& device);
  /// Writes 16 * blocks.size() vertices at the start of `posed`. Indices in `blocks` are the caller's to get right.
  void run(const RestVertices& rest, const Buffer<PosedBlock>& blocks, const Buffer<LimbPose>& limbs,
           PosedVertices& posed);

 private:
  std::size_t lanes_;
  Kernel kernel_;
};

}  // namespace understory
