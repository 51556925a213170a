// kernels/obscurance_half.cl and obscurance_upsample.cl: obscurance at half resolution and back.
#pragma once
#include "host/opencl/kernel.hpp"
#include "host/passes/lanes.hpp"
#include "host/passes/obscurance.hpp"

namespace understory {

/// The camera of the small image, whose pixel (x, y) is pixel (2x, 2y) of the large one.
ObscuranceView half_view(const ObscuranceView& view);

class ObscuranceHalfPass {
 public:
  explicit ObscuranceHalfPass(Device& device);
  /// `half`: planes of half_view(view), of which depth, normal and validity are written.
  void run(const FragmentPlanes& planes, const ObscuranceView& view, FragmentPlanes& half);

 private:
  Kernel kernel_;
};

class ObscuranceUpsamplePass {
 public:
  explicit ObscuranceUpsamplePass(Device& device, int lanes = 0);
  /// `half_visibility` to `visibility`; `reach` as in ObscuranceBlurPass. Adds the small image's codes 32 and 64.
  void run(const FragmentPlanes& half, const Buffer<float>& half_visibility, double reach, FragmentPlanes& planes,
           const ObscuranceView& view, Buffer<float>& visibility);

 private:
  Lanes lanes_;
  Kernel kernel_;
};

}  // namespace understory
