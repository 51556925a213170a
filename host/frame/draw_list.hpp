// What one frame poses and draws of a detail layout: sections and groups of blades inside the view, thinned by their
// distance. Made anew from (world, pose, camera); nothing is carried over from an earlier frame.
#pragma once
#include <cstdint>
#include <vector>

#include "host/frame/detail_layout.hpp"
#include "host/passes/geometry.hpp"
#include "sim/pose.hpp"

namespace understory {

/// 256 consecutive blades of a field, in an order of their own, as the view sees them.
struct BladeGroup {
  std::uint32_t first_blade = 0, blades = 0;  // in RestBlades; blades without the padding
  glm::dvec3 centre{0};                       // of a sphere around all bends of its blades, relative to the origin, m
  float radius = 0;
  float width = 0, length = 0;  // means, m
};

/// Blades of a world in the order in which they go, and their groups.
struct BladeLayout {
  std::vector<GrassBlades> fields;              // per World::grass
  std::vector<std::vector<BladeGroup>> groups;  // per field
};
BladeLayout lay_out_blades(const World& world);

struct DrawList {
  std::vector<PosedBlock> blocks;     // of meshes, in the order of the posed vertices
  std::vector<float> block_scale;     // of each block's leaves about their middles; empty unless thinned
  std::vector<TriangleChunk> chunks;  // meshes first
  std::uint32_t mesh_chunks = 0;
  std::vector<BladeUnit> blade_units;     // field after field
  std::vector<std::uint32_t> first_unit;  // per field, and the number of all
  std::uint32_t vertices = 0;             // posed, of meshes and grass
  std::uint64_t triangles = 0;            // handed to the rasteriser
};

class DrawLister {
 public:
  /// All must outlive the lister. `thinned` false: whatever is in view is listed whole.
  DrawLister(const World& world, const DetailLayout& layout, const BladeLayout& blades, bool thinned);
  /// The list of one frame; valid until the next call.
  const DrawList& list(const Pose& pose, const CameraView& camera);

 private:
  struct Part;  // what one instance adds
  void list_instance(std::size_t i, const Pose& pose, const CameraView& camera, Part& part) const;
  void gather(std::vector<Part>& parts);
  void list_grass(const Pose& pose, const CameraView& camera);

  const World& world_;
  const DetailLayout& layout_;
  const BladeLayout& blades_;
  bool thinned_;
  DrawList list_;
};

/// Centre and radius of a section's sphere at time t, camera-relative m: an arc of curvature k stretches what lies d
/// beside its axis by at most 1 + |k| d.
glm::vec4 posed_sphere(const LimbPose& limb, const DetailSection& section, double scale);

/// Whether any part of the sphere (camera-relative m) may fall on the image or within a pixel of it.
bool in_view(const CameraView& camera, const glm::dvec3& centre, double radius);

}  // namespace understory
