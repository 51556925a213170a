// kernels/cull_triangles.cl and kernels/rasterise.cl: posed triangles into the visibility buffer.
#pragma once
#include <optional>
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
  /// Clears `visible`, marks the triangles that may cover a pixel centre, and scan-converts them.
  /// `marks`: one byte per triangle slot, chunk_count * 256.
  void run(const TriangleTables& triangles, const PosedVertices& posed, const CameraView& camera,
           Buffer<std::uint8_t>& marks, VisibilityBuffer& visible);

 private:
  std::size_t lanes_;
  std::uint32_t triangles_per_item_;
  std::size_t local_size_;
  std::size_t words_per_item_;  // of the visibility buffer, when it is cleared
  Kernel clear_;
  std::optional<Kernel> cull_mesh_, cull_grass_;
  std::vector<Kernel> rasterise_mesh_, rasterise_grass_;  // one each with 64-bit atomics, else one per raster pass
};

}  // namespace understory
