// kernels/open_dome.cl: `open-dome`, the share of the dome above the horizon that each fragment faces, (1 + cos t)/2.
#pragma once
#include "host/opencl/kernel.hpp"
#include "host/passes/lanes.hpp"
#include "host/passes/planes.hpp"

namespace understory {

class OpenDomePass {
 public:
  explicit OpenDomePass(Device& device, int lanes = 0);
  /// `visibility`: [0, 1], of V_c; sized like the planes.
  void run(const FragmentPlanes& planes, Buffer<float>& visibility);

 private:
  Lanes lanes_;
  Kernel kernel_;
};

}  // namespace understory
