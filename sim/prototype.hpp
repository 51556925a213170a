// A plant, occluder or terrain mesh at rest, in its own frame: z up, metres, root at the origin.
// Instances share it. Its vertices belong to limbs, the stiff pieces that sway moves.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace understory {

/// What a surface is; the owner classes of DESIGN.md.
enum class SurfaceClass : std::uint8_t { background, terrain, leaf, wood, blade, occluder };
/// As the owner table of frame files names it.
inline const char* surface_class_name(SurfaceClass surface) {
  constexpr const char* names[] = {"background", "terrain", "leaf", "wood", "blade", "occluder"};
  return names[static_cast<std::size_t>(surface)];
}

enum class SwayKind : std::uint8_t { rigid, trunk, branch };

/// A stiff piece: a trunk or branch axis, or a rigid occluder part. Rest pose, prototype frame.
/// It bends as a circular arc of constant length in the plane of its axis and the wind's force.
struct Limb {
  std::int32_t parent = -1;  // index of an earlier limb; -1: stands on the prototype's root frame
  SwayKind kind = SwayKind::rigid;
  glm::vec3 base{0};        // where it is fixed to its parent, m
  glm::vec3 axis{0, 0, 1};  // unit, from base to tip
  float length = 1;         // m
  float reach = 0;          // largest distance of its wood from the straight axis, m: limits curvature (no stretching)
  float flexibility = 1;    // multiplies the species' deflection for this kind (thin twigs bend more)
  float delay = 0;          // s: shifts its response in time so that branches do not nod together
};

/// Vertices of one limb. Structure of arrays; every limb's vertices start at a multiple of `vertex_block`
/// and are padded to one by repeating the last vertex, so that a block of 16 shares its limb.
inline constexpr std::uint32_t vertex_block = 16;

struct VertexBlocks {
  std::vector<float> x, y, z;  // m, prototype frame; size = 16 * block_limb.size()
  std::vector<std::int8_t> flutter_x, flutter_y,
      flutter_z;                            // displacement of a leaf vertex at full flutter, unit `flutter_scale`/127
  std::vector<std::uint8_t> flutter_phase;  // 1/256 turn; one value per leaf
  std::vector<std::uint32_t> block_limb;    // limb of each block
};

/// Consecutive triangles of one class.
struct TriangleRun {
  SurfaceClass surface = SurfaceClass::wood;
  std::uint32_t first = 0, count = 0;  // in triangles
};

/// Which shell of a crown a model takes: one sphere, one ellipsoid, or the clustered spheres.
enum class CrownShape : std::uint8_t { sphere, ellipsoid, shells };

/// Shell of the foliage in rest pose: a minimal-volume fit (sim/crown.hpp). Hegeman et al. 2006, sections 3 and 5.
struct CrownShell {
  glm::vec3 sphere_centre{0};
  float sphere_radius = 0;  // m; 0: no crown
  glm::vec3 ellipsoid_centre{0};
  glm::mat3 ellipsoid_axes{1};    // columns: unit directions
  glm::vec3 ellipsoid_radii{0};   // m, along the columns
  std::vector<glm::vec4> shells;  // spheres around clusters of the foliage: centre, radius, m
  float leaf_area = 0;            // one-sided, m^2
  float plant_area = 0;           // leaf area + half the wood's surface, m^2
  std::uint32_t limb = 0;         // the limb whose sway carries the crown (the trunk)
  float trunk_height = 0;         // where along that limb, m: height of the sphere's centre
};

struct Prototype {
  std::string name;
  VertexBlocks vertices;
  std::vector<std::uint32_t> triangles;  // 3 per triangle, into `vertices`
  std::vector<TriangleRun> runs;         // cover all triangles, in order
  std::vector<Limb> limbs;               // parents before children; at least one
  float flutter_scale = 0;               // m
  CrownShell crown;
  glm::vec3 low{0}, high{0};  // bounding box at rest
  std::uint32_t triangle_count() const { return static_cast<std::uint32_t>(triangles.size() / 3); }
};

/// What a generator or mesh reader hands over: plain triangles with a class each, before limbs and blocks are made.
struct RawMesh {
  struct Part {
    std::string name;  // object or node
    std::string material;
    SurfaceClass surface = SurfaceClass::wood;
    std::vector<glm::vec3> positions;      // m, z up
    std::vector<std::uint32_t> triangles;  // 3 per triangle
  };
  std::vector<Part> parts;
};

}  // namespace understory
