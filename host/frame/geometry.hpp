// The world's triangles on the device: what does not change with time, uploaded once.
#pragma once
#include <cstdint>
#include <vector>

#include "host/passes/geometry.hpp"
#include "sim/world.hpp"

namespace understory {

/// Where one grass field stands in the blade and vertex planes.
struct FieldRange {
  std::uint32_t first_blade = 0;   // in RestBlades, a multiple of 256
  std::uint32_t blades = 0;        // padded to a multiple of 256
  std::uint32_t first_vertex = 0;  // in PosedVertices
};

struct Geometry {
  RestVertices rest;
  Buffer<PosedBlock> blocks;
  RestBlades blades;
  MeshGrass mesh_grass;
  TriangleTables triangles;
  PosedVertices posed;
  std::vector<FieldRange> fields;                 // per World::grass
  std::vector<TriangleChunk> chunks;              // host copy of triangles.chunks
  std::uint32_t mesh_vertices = 0, vertices = 0;  // posed, padding included
  bool has_mesh() const { return triangles.mesh_chunks > 0; }
  bool has_grass() const { return triangles.grass_chunks > 0; }
};

/// Lays out and uploads. Throws Error(invalid_input) when the device's memory limits are exceeded, or the scene has
/// more than 2^32 triangle slots.
Geometry upload_geometry(Device& device, const World& world);

/// The blades of `fields`, each field padded to whole groups, and its place among them; first_vertex as if posed one
/// after another from `vertex` on. Returns the vertex after the last.
std::uint32_t upload_blades(Device& device, const std::vector<GrassBlades>& fields, std::uint32_t vertex,
                            RestBlades& blades, std::vector<FieldRange>& ranges);

/// Heights of the plants of a mesh whose surface is blades; nothing in a scene without any blade.
MeshGrass upload_mesh_grass(Device& device, const World& world);

/// For every run of every prototype the entry of TriangleTables::index_a where it starts: runs are padded to whole
/// chunks. After the last run of the last prototype comes one more element, the number of entries.
std::vector<std::uint32_t> first_triangles(const World& world);

/// Number of limbs before each instance's own, in the order of World::instances (as Pose::first_limb).
std::vector<std::uint32_t> first_limbs(const World& world);

}  // namespace understory
