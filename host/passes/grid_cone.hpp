// kernels/grid_cone.cl: `grid-cone` and `grid-cone-paper`, occlusion by bodies from grids of cones (Malmer et al. 2005
// section 5).
#pragma once
#include "host/opencl/kernel.hpp"
#include "host/passes/cone_planes.hpp"
#include "host/passes/lanes.hpp"
#include "host/passes/planes.hpp"
#include "host/passes/tile_grids.hpp"

namespace understory {

class GridConePass {
 public:
  /// `method`: grid-cone, or grid-cone-paper; `combine`: multiply, simple or merge (kernels/shared/running_cone.h),
  /// or union (kernels/shared/seen_directions.h).
  /// `cones`: run fills cone planes. Throws Error(unexpected) for other names.
  GridConePass(Device& device, const std::string& method, const std::string& combine, int lanes = 0,
               bool cones = false);
  /// `grids`: packed_cone samples. `visibility`: V_c, sized like the planes; 1 outside all grids. Adds validity code
  /// 128 to fragments near the border of a grid, 16 deep within another body's solid.
  /// `cones`: sized like the planes, exactly for a pass that was built for them.
  void run(const FragmentPlanes& planes, const OwnerTables& owners, const GridTable& grids, Buffer<float>& visibility,
           const ConePlanes* cones = nullptr);

 private:
  std::string method_;
  Lanes lanes_;
  bool cones_;
  TileGridsPass tiles_;
  Kernel kernel_;
};

}  // namespace understory
