// kernels/screen_rays.cl: `screen-rays`, the share of rays that get past what the depth plane shows.
#pragma once
#include "host/opencl/kernel.hpp"
#include "host/passes/lanes.hpp"
#include "host/passes/obscurance.hpp"

namespace understory {

class ScreenRaysPass {
 public:
  /// `near_field`: radius, m, is how long the rays are, thickness, m, how deep surfaces are at least; above 0. Its
  /// normals must not be `none`, its falloff `constant`, its radius the only one. `rays`: of each fragment, 1 to 64.
  /// Throws Error(invalid_input) naming what is wrong.
  ScreenRaysPass(Device& device, const NearField& near_field, int rays, int lanes = 0);

  /// Visibility of rays of limited length, [0, 1] and 1 on the background, of width x height fragments in rows. Adds
  /// validity codes 32 and 64.
  void run(FragmentPlanes& planes, const ObscuranceView& view, Buffer<float>& visibility);

 private:
  Lanes lanes_;
  NearField near_field_;
  std::uint32_t rays_;
  Kernel kernel_;
};

}  // namespace understory
