// kernels/draw_blades.cl: listed blades of one field, posed in the wind of time t and drawn at once.
#pragma once
#include <vector>

#include "host/passes/pose_grass.hpp"
#include "host/passes/rasterise.hpp"

namespace understory {

class DrawBladesPass {
 public:
  /// `wide_atomics`: as RasterisePass.
  DrawBladesPass(Device& device, bool wide_atomics);
  /// Poses `count` units from `first` on into `posed` and draws them over what `visible` holds. Where units and chunks
  /// lie in `rest` and `posed` is the caller's to get right.
  void run(std::size_t raster_pass, const RestBlades& rest, const GrassWind& wind, const SwaySeries& series,
           const Buffer<BladeUnit>& units, std::uint32_t first, std::uint32_t count, const TriangleTables& triangles,
           const CameraView& camera, PosedVertices& posed, VisibilityBuffer& visible);

 private:
  std::size_t lanes_;
  std::vector<Kernel> kernels_;
};

}  // namespace understory
