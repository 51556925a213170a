// kernels/obscurance_area.cl: `obscurance-area`, section 4.2 of Loos & Sloan 2010.
#pragma once
#include "host/opencl/kernel.hpp"
#include "host/passes/depth_moments.hpp"
#include "host/passes/lanes.hpp"
#include "host/passes/obscurance.hpp"

namespace understory {

class ObscuranceAreaPass {
 public:
  /// `set`: of line_samples(). `spread`: half-width of the box of depths in standard deviations; the paper takes 1, but
  /// sqrt(3), the box of the measured variance, comes closer to the truth (bench/obscurance.md). Throws
  /// Error(invalid_input) for quadratic falloff, which has no such form.
  ObscuranceAreaPass(Device& device, const NearField& near_field, const ObscuranceSampleSet& set,
                     double spread = 1.7320508, int lanes = 0);
  /// As ObscuranceLinePass::run. `moments`: of the same planes and view.
  void run(FragmentPlanes& planes, const ObscuranceView& view, const DepthMoments& moments, Buffer<float>& visibility);

 private:
  Lanes lanes_;
  NearField near_field_;
  Buffer<ObscuranceRow> rows_;
  Kernel kernel_;
};

}  // namespace understory
