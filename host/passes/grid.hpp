// kernels/grid.cl: `grid` and `grid-self-paper`, occlusion by bodies from scalar grids (Malmer et al. 2005 section 4).
#pragma once
#include "host/opencl/kernel.hpp"
#include "host/passes/lanes.hpp"
#include "host/passes/planes.hpp"
#include "host/passes/tile_grids.hpp"

namespace understory {

class GridPass {
 public:
  /// `method`: grid, or grid-self-paper. Throws Error(unexpected) for another.
  GridPass(Device& device, const std::string& method, int lanes = 0);
  /// `grids`: packed_share samples. `visibility`: [0, 1], sized like the planes; 1 outside all grids. Adds validity
  /// code 128 to fragments near the border of a grid, 16 deep within a solid.
  void run(const FragmentPlanes& planes, const OwnerTables& owners, const GridTable& grids, Buffer<float>& visibility);

 private:
  std::string method_;
  Lanes lanes_;
  TileGridsPass tiles_;
  Kernel kernel_;
};

}  // namespace understory
