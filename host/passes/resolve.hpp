// kernels/resolve.cl: visible triangles to the planes that visibility passes read.
#pragma once
#include "host/opencl/kernel.hpp"
#include "host/passes/geometry.hpp"
#include "host/passes/planes.hpp"
#include "host/passes/rasterise.hpp"

namespace understory {

/// Which planes are written beside those that every pass may read.
struct ResolvedPlanes {
  bool grass_height = false;  // height_above_root and blade_length
  bool rest_point = false;    // rest_position and rest_normal
  bool texel = false;         // texel and texel_place
};

/// What the posed triangles were made from; buffers that no chosen plane needs may be empty.
struct RestGeometry {
  const RestBlades& blades;
  float root_offset_z = 0;  // added to blade roots to make them camera-relative, m
  const RestVertices* vertices = nullptr;
  const Buffer<PosedBlock>* blocks = nullptr;
  const Buffer<std::array<std::uint32_t, 2>>* faces = nullptr;  // CrownBakedTables::faces
  const MeshGrass* mesh_grass = nullptr;
};

/// Triangles of a frame that are posed and drawn a part at a time: which part this is.
struct Batch {
  bool first = true, last = true;
};

class ResolvePass {
 public:
  /// `wide_atomics`: as the visibility buffer was rasterised.
  ResolvePass(Device& device, const ResolvedPlanes& write, bool wide_atomics);
  /// After the first batch only fragments that a later one covers are written; before the last, `visible` forgets which
  /// triangles it saw and keeps their depths.
  /// `planes` hold what was chosen. `rest.vertices` and `rest.blocks` are needed for rest_point only,
  /// `rest.faces` for texel only, `rest.mesh_grass` for grass_height only.
  void run(const VisibilityBuffer& visible, const TriangleTables& triangles, const PosedVertices& posed,
           const RestGeometry& rest, const CameraView& camera, FragmentPlanes& planes, const Batch& batch = {});

 private:
  ResolvedPlanes write_;
  std::uint32_t lanes_;  // fragments per work-item
  Kernel kernel_;
};

}  // namespace understory
