// The triangles that one view needs: what lies outside it is neither posed nor drawn, and foliage, grass and twigs that
// are smaller than pixels are thinned when the scene asks for it. Shading does not look here: crowns, grids and bodies
// that are out of view still shade what is in it.
#pragma once
#include <optional>
#include <vector>

#include "host/frame/draw_list.hpp"
#include "host/frame/geometry.hpp"
#include "host/passes/pose_grass.hpp"
#include "host/passes/pose_mesh.hpp"

namespace understory {

class SeenGeometry {
 public:
  /// Uploads every prototype and blade once. `world` must outlive it. `thinned` false: pictures are those of
  /// upload_geometry.
  SeenGeometry(Device& device, const World& world, bool thinned);
  SeenGeometry(const SeenGeometry&) = delete;
  SeenGeometry& operator=(const SeenGeometry&) = delete;

  /// Poses what `camera` sees; geometry() then holds its vertices and chunks. `series`: per World::grass.
  void pose(const Pose& pose, const CameraView& camera, const std::vector<SwaySeries>& series);
  const Geometry& geometry() const { return geometry_; }
  /// The list of the last pose.
  const DrawList& list() const { return *list_; }
  /// CrownBakedTables::faces in the order of this geometry's triangles; null for null.
  const Buffer<std::array<std::uint32_t, 2>>* faces(const Buffer<std::array<std::uint32_t, 2>>* of_prototypes);

 private:
  void upload(const DetailLayout& layout, const World& world);

  Device& device_;
  bool thinned_;
  DetailLayout layout_;
  BladeLayout blades_;
  DrawLister lister_;
  const DrawList* list_ = nullptr;
  Geometry geometry_;
  EnlargedLeaves enlarged_;
  Buffer<LimbPose> limbs_;
  Buffer<BladeUnit> blade_units_;
  std::optional<PoseMeshPass> pose_mesh_;
  std::optional<PoseGrassPass> pose_grass_;
  Buffer<std::array<std::uint32_t, 2>> faces_;
};

}  // namespace understory
