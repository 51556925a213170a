// The occlusion grids of a scene's moving occluders: baked once for each different part, placed anew every frame.
#pragma once
#include <memory>
#include <vector>

#include "host/passes/grid.hpp"
#include "host/passes/grid_cone.hpp"
#include "sim/pose.hpp"

namespace understory {

/// True for the methods that need grids: grid, grid-self-paper, grid-cone, grid-cone-paper.
bool is_grid_method(const std::string& method);

class OccluderGrids {
 public:
  /// Bakes, or takes from the cache, the grid of each rigid part of the world's occluders; parts with the same
  /// triangles share one. Throws Error(invalid_input) naming the part whose mesh cannot be baked.
  /// `cone_fragments`: of the cone planes that grid-cone fills for an environment's light; 0: none.
  OccluderGrids(Device& device, const World& world, const Methods& methods, std::size_t cone_fragments);

  /// `visibility`: what occluders leave, sized like the planes.
  void run(const Pose& pose, const FragmentPlanes& planes, const OwnerTables& owners, Buffer<float>& visibility);

  /// The cones of the last run; null without.
  const ConePlanes* cones() const { return cones_.get(); }

 private:
  /// A rigid part: a limb of an instance, and the record of its grid less its place.
  struct Part {
    std::size_t instance = 0, limb = 0;
    GridRecord record{};
    glm::vec3 middle{0}, half{0};  // of its grid's box: centre and half-extents, m
  };
  std::vector<GridRecord> records_at(const Pose& pose) const;

  std::vector<Part> parts_;
  std::unique_ptr<GridTable> table_;
  std::unique_ptr<GridPass> scalar_;
  std::unique_ptr<GridConePass> cone_;
  std::unique_ptr<ConePlanes> cones_;
};

}  // namespace understory
