// Prototypes in an order that lets a frame draw less of them: limb by limb, the leaves of a limb in a fixed random
// order and in units that can be left out, beside the single triangles that stand for them and for thin twigs far away.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "sim/world.hpp"

namespace understory {

/// Triangles that are drawn or left out together: 8 leaves of two, or 16 leaves of which one triangle stands for all.
inline constexpr std::uint32_t unit_triangles = 16;

/// Triangles of one limb and one run of a prototype. Starts and numbers of triangles are multiples of unit_triangles,
/// filled up by triangles without area.
struct DetailSection {
  std::uint32_t limb = 0, run = 0;  // of the prototype
  std::uint32_t first_block = 0, blocks = 0;
  std::uint32_t first_triangle = 0, triangles = 0;  // corners count from the section's first vertex
  glm::vec3 centre{0};                              // of its bounding sphere at rest, flutter included, m
  float radius = 0;
  bool thins = false;             // leaves that go with distance, unit by unit, while the others grow
  bool is_far = false;            // drawn only in place of another: pieces of one triangle each
  std::uint32_t unit_blocks = 0;  // blocks of 16 vertices of a unit, where it has units; far: corners a, b and c
  float piece_radius = 0;         // largest distance of a vertex from the middle of its leaf, m
  float size = 0;                 // leaves: root of their mean area; twigs: mean diameter, m; 0: has no `far`
  std::int32_t far = -1;          // the section that stands for this one far away, in the prototype's list
};

/// All prototypes, one after another. Planes have one element per vertex, 16 per block.
struct DetailLayout {
  VertexBlocks vertices;                         // block_limb: of the prototype
  std::vector<float> pivot_x, pivot_y, pivot_z;  // m: middle of the vertex' leaf, or the vertex itself
  std::vector<std::uint32_t> a, b, c;            // corners of triangles
  std::vector<std::uint32_t> source;             // of each triangle: in the order of first_triangles(); or no_source
  std::vector<std::vector<DetailSection>> sections;  // per prototype
};
inline constexpr std::uint32_t no_source = 0xffffffffu;

/// `thinned`: with what stands for leaves and twigs far away.
DetailLayout lay_out_detail(const World& world, bool thinned);

}  // namespace understory
