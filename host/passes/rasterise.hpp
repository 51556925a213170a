// kernels/rasterise.cl: posed triangles into the visibility buffer.
#pragma once
#include <vector>

#include "host/opencl/kernel.hpp"
#include "host/passes/geometry.hpp"

namespace understory {

/// Per pixel the nearest triangle; see kernels/shared/visibility_buffer.h for the two layouts.
struct VisibilityBuffer {
  Buffer<std::uint32_t> words;  // two per pixel
};

/// The forms of a drawing kernel: one with 64-bit atomics; else two, of which the first finds every pixel's depth and
/// the second its triangle, each over all that is drawn.
std::vector<Kernel> raster_kernels(Device& device, const char* program, const char* name, bool wide_atomics);

class RasterisePass {
 public:
  /// `mesh`, `grass`: which kinds of triangles the scene has; kernels of an absent kind are not built.
  /// `wide_atomics` false: the two-pass form for devices without 64-bit atomics; same pixels.
  RasterisePass(Device& device, bool mesh, bool grass, bool wide_atomics);
  void clear(VisibilityBuffer& visible);
  /// How often all has to be drawn.
  std::size_t raster_passes() const { return wide_atomics_ ? 1 : 2; }
  /// Draws chunks `first` up to `end` of meshes over what the buffer holds.
  void draw_mesh(std::size_t raster_pass, const TriangleTables& triangles, std::uint32_t first, std::uint32_t end,
                 const PosedVertices& posed, const CameraView& camera, VisibilityBuffer& visible);
  /// Draws every triangle of the kinds this pass was made for into a cleared buffer.
  void run(const TriangleTables& triangles, const PosedVertices& posed, const CameraView& camera,
           VisibilityBuffer& visible);

 private:
  std::size_t lanes_;
  bool wide_atomics_;
  Kernel clear_;
  std::vector<Kernel> rasterise_mesh_, rasterise_grass_;
};

}  // namespace understory
