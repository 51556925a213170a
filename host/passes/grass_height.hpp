// kernels/grass_height.cl: `grass-height`, eq. 9 of Hegeman et al. 2006 without its open-dome factor.
#pragma once
#include "host/opencl/kernel.hpp"
#include "host/passes/lanes.hpp"
#include "host/passes/planes.hpp"

namespace understory {

class GrassHeightPass {
 public:
  explicit GrassHeightPass(Device& device, int lanes = 0);
  /// Reads planes.height_above_root and planes.blade_length too. `visibility`: [0, 1], 1 for all but blades; sized like
  /// the planes. Adds validity code 8 to blades' fragments whose height is not within [0, blade_length].
  void run(const FragmentPlanes& planes, const OwnerTables& owners, Buffer<float>& visibility);

 private:
  Lanes lanes_;
  Kernel kernel_;
};

}  // namespace understory
