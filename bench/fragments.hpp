// A made-up G-buffer for the kernel benchmarks: tiles of 16 x 16 fragments that belong together, as in pictures, on 64
// crowns, or on blades or on ground alone. Each fragment is a function of its index, so that a reference needs no copy
// of the planes.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "host/passes/ambient.hpp"
#include "host/passes/planes.hpp"
#include "kernels/shared/records.h"
#include "sim/random.hpp"

namespace understory {

struct BenchFragment {
  glm::vec3 position{0}, normal{0, 0, 1};  // camera-relative m; unit
  std::uint32_t owner = 0;
  float height = 0, blade_length = 0;  // m; blades only
};

class BenchFragments {
 public:
  /// What fills the picture.
  enum class Cover { crowns, grass, ground };

  /// At least `fragments` of them, in whole rows of 2048; below 32768 in rows of 128.
  BenchFragments(Device& device, std::size_t fragments, Cover filled_by = Cover::crowns);

  BenchFragment at(std::size_t index) const;
  /// Height of `cover`'s visibility at a place within its extent: an affine function, which interpolation reproduces.
  static double cover_at(double x, double y);

  const std::vector<Owner>& owner_rows() const { return owner_rows_; }
  const std::vector<CrownRecord>& crown_rows() const { return crown_rows_; }
  const std::vector<ShadingSphere>& sphere_rows() const { return sphere_rows_; }

  FragmentPlanes planes;
  OwnerTables owners;
  Buffer<CrownRecord> crowns;
  Buffer<ShadingSphere> spheres;
  GroundCoverTable cover;

 private:
  std::uint32_t owner_of_tile(Random& random) const;
  void upload();

  Cover filled_by_;

  std::vector<Owner> owner_rows_;  // background, one per crown, blades, terrain
  std::vector<CrownRecord> crown_rows_;
  std::vector<ShadingSphere> sphere_rows_;
};

}  // namespace understory
