// kernels/pose_mesh.cl: rest vertices of plants, occluders and terrain to where they are at time t.
#pragma once
#include "host/opencl/kernel.hpp"
#include "host/passes/geometry.hpp"

namespace understory {

class PoseMeshPass {
 public:
  /// `thinned`: leaves are enlarged by a factor per block.
  explicit PoseMeshPass(Device& device, bool thinned = false);
  /// Writes 16 * blocks.size() vertices at the start of `posed`. Indices in `blocks` are the caller's to get right.
  void run(const RestVertices& rest, const Buffer<PosedBlock>& blocks, const Buffer<LimbPose>& limbs,
           PosedVertices& posed);
  /// The same for blocks `first` up to `end`, to the places that follow from their numbers. `enlarged` is needed when
  /// the pass was made for it.
  void run(const RestVertices& rest, const Buffer<PosedBlock>& blocks, std::size_t first, std::size_t end,
           const Buffer<LimbPose>& limbs, const EnlargedLeaves* enlarged, PosedVertices& posed);

 private:
  bool thinned_;
  std::size_t lanes_;
  Kernel kernel_;
};

}  // namespace understory
