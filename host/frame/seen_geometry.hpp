// The triangles that one view needs: what lies outside it is neither posed nor drawn, and foliage, grass and twigs that
// are smaller than pixels are thinned when the scene asks for it. Shading does not look here: crowns, grids and bodies
// that are out of view still shade what is in it.
#pragma once
#include <optional>
#include <vector>

#include "host/frame/draw_list.hpp"
#include "host/frame/geometry.hpp"
#include "host/passes/farthest_depth.hpp"
#include "host/passes/pose_grass.hpp"
#include "host/passes/pose_mesh.hpp"

namespace understory {

/// Posed vertices of 256 MiB.
inline constexpr std::uint32_t usual_batch = 1u << 24;

class SeenGeometry {
 public:
  /// Uploads every prototype and blade once. `world` must outlive it. `thinned` false: pictures are those of
  /// upload_geometry.
  /// Vertices are posed in batches of at most `most_vertices` and of what the device can hold in one buffer.
  SeenGeometry(Device& device, const World& world, bool thinned, std::uint32_t most_vertices = usual_batch);
  SeenGeometry(const SeenGeometry&) = delete;
  SeenGeometry& operator=(const SeenGeometry&) = delete;

  /// Starts a frame of `pose` (without the limbs of plants), which must live until its last batch is posed.
  void begin(const Pose& pose, const CameraView& camera);
  /// Poses what may hide the rest of the frame, before its first batch. False: there is nothing of the kind in view, or
  /// the device has no 64-bit atomics, without which a batch is drawn at once.
  bool pose_hiders();
  /// Leaves out what is hidden behind the hiders, once they are drawn.
  void leave_out_behind(const VisibilityBuffer& visible);
  /// Poses the next batch of what the camera sees; geometry() then holds its vertices and chunks, after those of the
  /// hiders in the first batch. `series`: per World::grass. Returns whether more follow.
  bool pose_next(const std::vector<SwaySeries>& series);
  /// The batch's first chunk that is not drawn yet.
  std::uint32_t first_chunk() const { return first_chunk_; }
  const Geometry& geometry() const { return geometry_; }
  /// The last batch.
  const DrawList& list() const { return *list_; }
  /// CrownBakedTables::faces in the order of this geometry's triangles; null for null.
  const Buffer<std::array<std::uint32_t, 2>>* faces(const Buffer<std::array<std::uint32_t, 2>>* of_prototypes);

 private:
  void upload(const DetailLayout& layout, const World& world);
  void write_list();
  void pose_list();

  Device& device_;
  bool thinned_;
  DetailLayout layout_;
  BladeLayout blades_;
  DrawLister lister_;
  const Pose* pose_ = nullptr;
  const DrawList* list_ = nullptr;
  std::size_t limbs_there_ = 0, blocks_there_ = 0, chunks_there_ = 0;  // of the list: on the device and posed already
  std::uint32_t first_chunk_ = 0;
  CameraView camera_{};
  DrawnDepth drawn_;
  std::optional<FarthestDepthPass> farthest_depth_;  // where something may hide something
  Buffer<float> farthest_;
  Geometry geometry_;
  EnlargedLeaves enlarged_;
  Buffer<LimbPose> limbs_;
  Buffer<BladeUnit> blade_units_;
  std::optional<PoseMeshPass> pose_mesh_;
  std::optional<PoseGrassPass> pose_grass_;
  Buffer<std::array<std::uint32_t, 2>> faces_;
};

}  // namespace understory
