// kernels/crown_transmittance.cl: `crown-transmittance`, the mean transmittance of even foliage in each crown's shells.
#pragma once
#include "host/opencl/kernel.hpp"
#include "host/passes/lanes.hpp"
#include "host/passes/planes.hpp"
#include "kernels/shared/transmittance_shell.h"

namespace understory {

class CrownTransmittancePass {
 public:
  /// `dome`: V holds the horizon (`sky: dome`); shells must be fitted for the same sky (sim/transmittance_fit.hpp).
  CrownTransmittancePass(Device& device, bool dome, int lanes = 0);
  /// Crown i is shells[first[i]] up to shells[first[i + 1]]; `crowns` of them, at least one shell. `visibility`: [0,
  /// 1], 1 without a crown; sized like the planes. Adds validity code 8 to fragments outside all shells of their crown.
  void run(const FragmentPlanes& planes, const OwnerTables& owners, const Buffer<std::uint32_t>& first,
           std::size_t crowns, const Buffer<TransmittanceShell>& shells, Buffer<float>& visibility);

 private:
  Lanes lanes_;
  Kernel kernel_;
};

}  // namespace understory
