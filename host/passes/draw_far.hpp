// kernels/draw_far.cl: far leaves and twigs, one triangle each, posed at time t and drawn at once.
#pragma once
#include <vector>

#include "host/passes/pose_mesh.hpp"
#include "host/passes/rasterise.hpp"

namespace understory {

class DrawFarPass {
 public:
  /// `wide_atomics`: as RasterisePass.
  DrawFarPass(Device& device, bool wide_atomics);
  /// Poses `count` units into `posed` and draws them over what `visible` holds. `block_scale`: per posed block, how
  /// much larger its leaves are than at rest.
  void run(std::size_t raster_pass, const RestVertices& rest, const Buffer<PosedBlock>& blocks,
           const Buffer<float>& block_scale, const Buffer<LimbPose>& limbs, const Buffer<FarUnit>& units,
           std::size_t count, const CameraView& camera, PosedVertices& posed, VisibilityBuffer& visible);

 private:
  std::size_t lanes_;
  std::vector<Kernel> kernels_;
};

}  // namespace understory
