// kernels/shells_cap.cl: `shells-cap` and `shells-cap-levels`, eq. 4-6 of Hegeman et al. 2006 in the nearest of each
// crown's clustered spheres.
#pragma once
#include "host/opencl/kernel.hpp"
#include "host/passes/lanes.hpp"
#include "host/passes/planes.hpp"
#include "kernels/shared/records.h"

namespace understory {

class ShellsCapPass {
 public:
  /// `levels`: the whole crown's visibility multiplies that of the nearest sphere.
  ShellsCapPass(Device& device, bool levels, int lanes = 0);
  /// Crown i is shells[first[i]] up to shells[first[i + 1]], the sphere around all of it first; `crowns` of them, at
  /// least one shell. `visibility`: [0, 1], 1 without a crown; sized like the planes. Adds validity code 8 to fragments
  /// outside the sphere that owns them.
  void run(const FragmentPlanes& planes, const OwnerTables& owners, const Buffer<std::uint32_t>& first,
           std::size_t crowns, const Buffer<CrownRecord>& shells, Buffer<float>& visibility);

 private:
  Lanes lanes_;
  Kernel kernel_;
};

}  // namespace understory
