// What one frame poses and draws of a detail layout: sections and groups of blades inside the view, thinned by their
// distance. Made anew from (world, pose, camera); nothing is carried over from an earlier frame. A frame that poses
// more vertices than the device should hold at once is listed in batches.
#pragma once
#include <cstdint>
#include <vector>

#include "host/frame/detail_layout.hpp"
#include "host/frame/hidden.hpp"
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

/// Sections of meshes, one after another. Vertices count from the first block.
struct ListedSections {
  std::vector<PosedBlock> blocks;  // in the order of the posed vertices
  std::vector<float> block_scale;  // of each block's leaves about their middles; empty unless thinned
  std::vector<TriangleChunk> chunks;
};

/// One batch. First what is posed and then drawn, then far pieces, then grass, both of which are drawn as they are
/// posed.
struct DrawList {
  std::vector<LimbPose> limbs;   // of its instances
  ListedSections mesh;           // with far pieces; chunks of grass after them
  std::size_t posed_blocks = 0;  // before those of far pieces
  std::uint32_t posed_chunks = 0;
  std::vector<FarUnit> far_units;
  std::uint32_t mesh_chunks = 0;          // with those of far pieces
  std::vector<BladeUnit> blade_units;     // field after field
  std::vector<std::uint32_t> first_unit;  // per field, and the number of all
  std::uint32_t vertices = 0;             // posed, of meshes and grass
  std::uint64_t triangles = 0;            // handed to the rasteriser
};

class DrawLister {
 public:
  /// All must outlive the lister. `thinned` false: whatever is in view is listed whole. `most_vertices`: of a batch,
  /// unless a single instance or group of blades has more.
  DrawLister(const World& world, const DetailLayout& layout, const BladeLayout& blades, bool thinned,
             std::uint32_t most_vertices = 0xffffffffu);
  /// Starts a frame. `pose` without the limbs of plants; it must live as long as the frame is listed.
  void begin(const Pose& pose, const CameraView& camera);
  /// Before the first batch: what may hide the rest, solid bodies and ground with relief in view, as its beginning.
  /// Nothing is listed when there is none.
  const DrawList& hiders();
  /// What is hidden by what is drawn so far is left out from now on. Must live as long as the frame is listed.
  void leave_out_behind(const DrawnDepth& drawn) { drawn_ = &drawn; }
  /// The next batch, which may be empty, or the whole of the batch that hiders() began; valid until the next call.
  const DrawList& next();
  /// Whether something is left to be listed.
  bool more() const;

 private:
  /// What one instance adds; vertices and limbs count from its own.
  struct Part {
    std::vector<LimbPose> limbs;
    ListedSections posed, far;
    std::vector<FarUnit> far_units;  // first_triangle counts from the first chunk of `far`
    std::uint64_t triangles = 0;
    std::size_t vertices() const { return (posed.blocks.size() + far.blocks.size()) * vertex_block; }
  };
  /// What is nearer hides what comes later, which then costs less; what may hide it whole comes first of all.
  void order_nearest_first();
  void clear_list();
  /// Whether a sphere is in view and not known to be hidden.
  bool may_be_seen(const glm::dvec3& centre, double radius) const;
  void list_instance(std::size_t i, Part& part) const;
  void list_section(const DetailSection& section, const Instance& instance, const std::vector<float>& areas,
                    Part& part) const;
  void list_wave();
  void append(Part& part);
  /// Puts the far pieces of all parts behind what is posed.
  void append_far();
  void list_group(std::size_t field, const BladeGroup& group);
  void list_grass();

  struct Place {
    double distance = 0;  // from the eye, m
    std::uint32_t index = 0;
  };

  const World& world_;
  const DetailLayout& layout_;
  const BladeLayout& blades_;
  bool thinned_;
  std::uint32_t most_vertices_;
  const Pose* pose_ = nullptr;
  const DrawnDepth* drawn_ = nullptr;
  CameraView camera_{};
  std::size_t hiders_ = 0;  // so many come first in instances_
  bool has_begun_ = false;  // the list, by hiders()
  std::size_t next_instance_ = 0, next_field_ = 0, next_group_ = 0;
  std::vector<Place> instances_;            // nearest first
  std::vector<std::vector<Place>> groups_;  // per field, nearest first
  std::vector<Part> waiting_;               // listed, and not yet part of a batch, from next_part_ on
  std::size_t next_part_ = 0;
  ListedSections far_;  // of the parts of this batch
  std::vector<FarUnit> far_units_;
  std::vector<float> widths_;
  DrawList list_;
};

/// Whether a mesh may hide what is behind it: solid, and no level plane, behind which nothing stands.
bool may_hide(const Prototype& prototype);
/// Whether anything in the world may.
bool has_hiders(const World& world);
/// Whether anything has leaves or wood, of which some may be drawn as far pieces.
bool has_far_pieces(const World& world);

/// Centre and radius of a section's sphere at time t, camera-relative m: an arc of curvature k stretches what lies d
/// beside its axis by at most 1 + |k| d.
glm::vec4 posed_sphere(const LimbPose& limb, const DetailSection& section, double scale);

/// Whether any part of the sphere (camera-relative m) may fall on the image or within a pixel of it.
bool in_view(const CameraView& camera, const glm::dvec3& centre, double radius);

}  // namespace understory
