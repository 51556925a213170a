// kernels/check_fragments.cl: `check-fragments`, for planes that another program rendered. The planes of our own
// resolve pass need no check.
#pragma once
#include "host/opencl/kernel.hpp"
#include "host/passes/lanes.hpp"
#include "host/passes/planes.hpp"

namespace understory {

class CheckFragmentsPass {
 public:
  explicit CheckFragmentsPass(Device& device, int lanes = 0);
  /// Adds validity code 2 where a position or normal is not finite (or the normal 0), and code 4 where a normal's
  /// length is off by more than 5e-4; those normals are renormalised in place. Background is left alone.
  void run(const FragmentPlanes& planes);

 private:
  Lanes lanes_;
  Kernel kernel_;
};

}  // namespace understory
