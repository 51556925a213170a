// kernels/tile_spheres.cl and kernels/solid_angle.cl: `solid-angle`, `solid-angle-exact`, `solid-angle-cosine`: how
// spheres (crowns of other plants, pieces of moving occluders) shade fragments.
#pragma once
#include <array>
#include <string>

#include "host/opencl/kernel.hpp"
#include "host/passes/lanes.hpp"
#include "host/passes/planes.hpp"
#include "kernels/shared/records.h"
#include "kernels/shared/tile_occlusion.h"

namespace understory {

/// How much distant spheres may be approximated together, per tile of 128 x 4 fragments, as changes of V.
struct FarFieldError {
  float each = 1.0f / 640;  // of one sphere
  float total = 1.0f / 64;  // of all spheres: the bound holds for each fragment; 0: every sphere exactly
};

class SolidAnglePass {
 public:
  /// `method`: one of the three names, or crown-shells: solid-angle-cosine of clustered spheres, which differs in
  /// its spheres only; also the pass name in timings. Throws Error(unexpected) for another.
  SolidAnglePass(Device& device, const std::string& method, FarFieldError error = {}, int lanes = 0);
  /// The first `sphere_count` records of `spheres` shade; 0 leaves all open. `visibility`: [0, 1], sized like the
  /// planes. Adds validity code 16 to fragments within a sphere of another group.
  void run(const FragmentPlanes& planes, const OwnerTables& owners, const Buffer<ShadingSphere>& spheres,
           std::size_t sphere_count, Buffer<float>& visibility);

 private:
  void fit_tables(std::size_t tiles, std::size_t entries);

  Device* device_;
  std::string method_;
  FarFieldError error_;
  Lanes lanes_;
  Kernel list_, shade_;
  Buffer<TileOcclusion> tiles_;
  Buffer<std::array<std::uint32_t, 2>> lists_;  // row of the sphere table, bits of 1/radius
};

}  // namespace understory
