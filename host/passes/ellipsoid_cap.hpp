// kernels/ellipsoid_cap.cl: `ellipsoid-cap`, eq. 4-6 of Hegeman et al. 2006 on each crown's ellipsoid.
#pragma once
#include "host/opencl/kernel.hpp"
#include "host/passes/lanes.hpp"
#include "host/passes/planes.hpp"
#include "kernels/shared/records.h"

namespace understory {

class EllipsoidCapPass {
 public:
  explicit EllipsoidCapPass(Device& device, int lanes = 0);
  /// `crowns`: rows that OwnerTables::crown names, at least one. `visibility`: [0, 1], 1 without a crown; sized like
  /// the planes. Adds validity code 8 to fragments outside their crown's ellipsoid.
  void run(const FragmentPlanes& planes, const OwnerTables& owners, const Buffer<CrownRecord>& crowns,
           Buffer<float>& visibility);

 private:
  Lanes lanes_;
  Kernel kernel_;
};

}  // namespace understory
