// kernels/farthest_depth.cl: what the tiles of a visibility buffer hide.
#pragma once
#include "host/passes/rasterise.hpp"

namespace understory {

class FarthestDepthPass {
 public:
  /// The device must have 64-bit atomics, and so must the buffer have been drawn.
  explicit FarthestDepthPass(Device& device) : kernel_(device, "farthest_depth", "farthest_depth", "farthest_depth") {}
  /// `farthest`: m ahead of the eye, one per tile of 8 x 8 pixels, row by row (kernels/shared/farthest_depth.h);
  /// infinite where a pixel shows nothing.
  void run(const VisibilityBuffer& visible, const CameraView& camera, Buffer<float>& farthest);

 private:
  Kernel kernel_;
};

}  // namespace understory
