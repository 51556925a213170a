// Device buffers that the geometry passes (pose, cull, rasterise, resolve) hand to each other.
#pragma once
#include <array>
#include <cstdint>

#include "host/opencl/buffer.hpp"
#include "kernels/shared/records.h"

namespace understory {

/// Rest vertices of all prototypes, one after another; each prototype starts at a multiple of 16 (sim/prototype.hpp).
struct RestVertices {
  Buffer<float> x, y, z;                                // m, prototype frame
  Buffer<std::int8_t> flutter_x, flutter_y, flutter_z;  // -127..127
  Buffer<std::uint8_t> flutter_phase;                   // 1/256 turn
};

/// Thinned foliage: the middle of each rest vertex' leaf (prototype frame, m), and by which factor the leaves of each
/// posed block are enlarged about theirs.
struct EnlargedLeaves {
  Buffer<float> pivot_x, pivot_y, pivot_z;
  Buffer<float> block_scale;
};

/// Blades of all fields, one after another, each field padded to a multiple of 256 by blades of length 0.
struct RestBlades {
  Buffer<float> root_x, root_y, root_z;  // m, relative to the origin
  Buffer<float> length, half_width;      // m
  Buffer<float> bend_x, bend_y;          // radians
  Buffer<float> facing_x, facing_y;      // unit, along the blade's width
  Buffer<float> flexibility, phase;      // 1; radians
};

/// Vertices at time t: first every mesh instance's blocks of 16, then 7 x 256 for each 256 blades; in lists of
/// blades 2 pairs + 1 instead of 7 (records.h, BladeUnit).
struct PosedVertices {
  Buffer<std::array<float, 4>> points;  // x, y, z, unused; m, camera-relative, world axes
};

/// Triangles of the whole scene. Chunks of meshes first, then those of grass; ids are chunk * 256 + lane.
struct TriangleTables {
  Buffer<std::uint32_t> index_a, index_b, index_c;  // per prototype triangle, into the prototype's vertices
  Buffer<TriangleChunk> chunks;
  std::uint32_t mesh_chunks = 0, grass_chunks = 0;
  std::uint32_t chunk_count() const { return mesh_chunks + grass_chunks; }
};

inline constexpr std::uint32_t triangles_per_chunk = 256;
inline constexpr std::uint32_t blades_per_group = 256;
inline constexpr std::uint32_t blades_per_unit = 16;  // of a BladeUnit
inline constexpr std::uint32_t vertices_per_blade = 7, triangles_per_blade = 5;

/// Grass that stands as a mesh, by row of the owner table: z of its root relative to the origin, and how high it is, m;
/// height 0: no grass.
struct MeshGrass {
  Buffer<float> root_z, height;
};

}  // namespace understory
