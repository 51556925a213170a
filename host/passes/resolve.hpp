// kernels/resolve.cl: visible triangles to the planes that visibility passes read.
#pragma once
#include "host/opencl/kernel.hpp"
#include "host/passes/geometry.hpp"
#include "host/passes/planes.hpp"
#include "host/passes/rasterise.hpp"

namespace understory {

class ResolvePass {
 public:
  /// `grass_height`: also write height_above_root and blade_length of the planes. `wide_atomics`: as the visibility
  /// buffer was rasterised.
  ResolvePass(Device& device, bool grass_height, bool wide_atomics);
  /// `root_offset_z`: added to blade roots to make them camera-relative, m.
  void run(const VisibilityBuffer& visible, const TriangleTables& triangles, const PosedVertices& posed,
           const RestBlades& blades, const CameraView& camera, float root_offset_z, FragmentPlanes& planes);

 private:
  bool grass_height_;
  Kernel kernel_;
};

}  // namespace understory
