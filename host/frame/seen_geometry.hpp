// The triangles that one view needs: what lies outside it is neither posed nor drawn, and foliage, grass and twigs that
// are smaller than pixels are thinned when the scene asks for it. Shading does not look here: crowns, grids and bodies
// that are out of view still shade what is in it.
#pragma once
#include <optional>
#include <vector>

#include "host/frame/draw_list.hpp"
#include "host/frame/geometry.hpp"
#include "host/passes/draw_blades.hpp"
#include "host/passes/draw_far.hpp"
#include "host/passes/farthest_depth.hpp"
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
  /// Draws what may hide the rest of the frame, before its first batch, and leaves out what is hidden behind it.
  /// Nothing happens when there is nothing of the kind in view, or the device has no 64-bit atomics, without which a
  /// batch is drawn at once.
  void draw_hiders(RasterisePass& rasterise, VisibilityBuffer& visible);
  /// Poses the next batch of what the camera sees and draws it over what `visible` holds; geometry() then has its
  /// vertices and chunks. `series`: per World::grass. Returns whether more follow.
  bool draw_next(const std::vector<SwaySeries>& series, RasterisePass& rasterise, VisibilityBuffer& visible);
  const Geometry& geometry() const { return geometry_; }
  /// The last batch.
  const DrawList& list() const { return *list_; }
  /// CrownBakedTables::faces in the order of this geometry's triangles; null for null.
  const Buffer<std::array<std::uint32_t, 2>>* faces(const Buffer<std::array<std::uint32_t, 2>>* of_prototypes);

 private:
  void upload(const DetailLayout& layout, const World& world);
  void write_list();
  void pose_list();
  void draw_blades(std::size_t raster_pass, const std::vector<SwaySeries>& series, VisibilityBuffer& visible);

  Device& device_;
  bool thinned_;
  DetailLayout layout_;
  BladeLayout blades_;
  DrawLister lister_;
  const Pose* pose_ = nullptr;
  const DrawList* list_ = nullptr;
  // Of the list: on the device, posed and drawn already.
  std::size_t limbs_there_ = 0, blocks_there_ = 0;
  std::uint32_t chunks_there_ = 0;
  CameraView camera_{};
  DrawnDepth drawn_;
  std::optional<FarthestDepthPass> farthest_depth_;  // where something may hide something
  Buffer<float> farthest_;
  Geometry geometry_;
  EnlargedLeaves enlarged_;
  Buffer<LimbPose> limbs_;
  Buffer<FarUnit> far_units_;
  Buffer<BladeUnit> blade_units_;
  std::optional<PoseMeshPass> pose_mesh_;
  std::optional<DrawFarPass> draw_far_;
  std::optional<DrawBladesPass> draw_blades_;
  Buffer<std::array<std::uint32_t, 2>> faces_;
};

}  // namespace understory
