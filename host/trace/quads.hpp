// Triangles that share an edge, in pairs: Embree traces a quad for little more than a triangle, and leaves, blades and
// terrain cells are pairs. The surface stays the same, whether the pair is flat or not.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace understory {

struct QuadMesh {
  /// Corners v0 to v3. Embree splits a quad into (v0, v1, v3) and (v2, v3, v1); a triangle alone has v3 = v2.
  std::vector<std::array<std::uint32_t, 4>> corners;
  /// The triangles that a quad's halves were; of one alone, its own number twice.
  std::vector<std::array<std::uint32_t, 2>> triangles;
};

/// Pairs each triangle, in order, with the first later one that runs along one of its edges the other way (same
/// winding). `triangles`: three indices below `vertex_count` each.
QuadMesh pair_triangles(std::size_t vertex_count, std::span<const std::uint32_t> triangles);

}  // namespace understory
