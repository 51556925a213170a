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

class RasterisePass {
 public:
  /// `mesh`, `grass`: which kinds of triangles the scene has; kernels of an absent kind are not built.
  /// `wide_atomics` false: the two-pass form for devices without 64-bit atomics; same pixels.
  RasterisePass(Device& device, bool mesh, bool grass, bool wide_atomics);
  /// Draws every triangle of the kinds this pass was made for, into a cleared buffer or over what it holds. Those of
  /// the chunks before `first_chunk`, which are of meshes, it holds already: with 64-bit atomics only.
  void run(const TriangleTables& triangles, const PosedVertices& posed, const CameraView& camera,
           VisibilityBuffer& visible, bool clear = true, std::uint32_t first_chunk = 0);

 private:
  std::size_t lanes_;
  std::size_t words_per_item_;  // of the visibility buffer, when it is cleared
  Kernel clear_;
  std::vector<Kernel> rasterise_mesh_, rasterise_grass_;  // one each with 64-bit atomics, else one per raster pass
};

}  // namespace understory
