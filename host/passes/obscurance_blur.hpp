// kernels/obscurance_blur.cl: `obscurance-blur`, the edge-aware separable blur of section 4.1 of Loos & Sloan 2010.
#pragma once
#include "host/opencl/kernel.hpp"
#include "host/passes/lanes.hpp"
#include "host/passes/obscurance.hpp"

namespace understory {

class ObscuranceBlurPass {
 public:
  explicit ObscuranceBlurPass(Device& device, int lanes = 0);
  /// Blurs `visibility` in place, by way of `scratch`, over `radius` pixels each way along rows, then columns. A pixel
  /// counts in full on the fragment's tangent plane and not at all from `reach` metres over it.
  void run(const FragmentPlanes& planes, const ObscuranceView& view, int radius, double reach,
           Buffer<float>& visibility, Buffer<float>& scratch);

 private:
  Lanes lanes_;
  Kernel kernel_;
};

}  // namespace understory
