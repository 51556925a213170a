// kernels/grid_cone.cl: `grid-cone` and `grid-cone-paper`, occlusion by bodies from grids of cones (Malmer et al. 2005
// section 5).
#pragma once
#include "host/opencl/kernel.hpp"
#include "host/passes/lanes.hpp"
#include "host/passes/planes.hpp"
#include "host/passes/tile_grids.hpp"

namespace understory {

class GridConePass {
 public:
  /// `method`: grid-cone, or grid-cone-paper; `combine`: multiply, simple or merge (kernels/shared/running_cone.h).
  /// Throws Error(unexpected) for others.
  GridConePass(Device& device, const std::string& method, const std::string& combine, int lanes = 0);
  /// `grids`: packed_cone samples. `visibility`: V_c, sized like the planes; 1 outside all grids. Adds validity code
  /// 128 to fragments near the border of a grid.
  void run(const FragmentPlanes& planes, const OwnerTables& owners, const GridTable& grids, Buffer<float>& visibility);

 private:
  std::string method_;
  Lanes lanes_;
  TileGridsPass tiles_;
  Kernel kernel_;
};

}  // namespace understory
