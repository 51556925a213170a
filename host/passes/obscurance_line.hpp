// kernels/obscurance_line.cl: `obscurance-line`, section 4.1 of Loos & Sloan 2010.
#pragma once
#include "host/opencl/kernel.hpp"
#include "host/passes/lanes.hpp"
#include "host/passes/obscurance.hpp"

namespace understory {

class ObscuranceLinePass {
 public:
  /// `set`: of line_samples(), or any points of the unit disc whose shares sum to 1.
  ObscuranceLinePass(Device& device, const NearField& near_field, const ObscuranceSampleSet& set, int lanes = 0);
  /// `visibility`: obscurance O in [0, 1], 1 = open; 1 on the background. Sized like the planes, which are the image of
  /// `view`. Adds validity codes 32 and 64.
  void run(FragmentPlanes& planes, const ObscuranceView& view, Buffer<float>& visibility);

 private:
  Lanes lanes_;
  NearField near_field_;
  Buffer<ObscuranceRow> rows_;
  Kernel kernel_;
};

}  // namespace understory
