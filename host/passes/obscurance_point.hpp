// kernels/obscurance_point.cl: `obscurance-point`, the point samples that Loos & Sloan 2010 compare lines with.
#pragma once
#include "host/opencl/kernel.hpp"
#include "host/passes/lanes.hpp"
#include "host/passes/obscurance.hpp"

namespace understory {

class ObscurancePointPass {
 public:
  /// `set`: of point_samples().
  ObscurancePointPass(Device& device, const NearField& near_field, const ObscuranceSampleSet& set, int lanes = 0);
  /// As ObscuranceLinePass::run.
  void run(FragmentPlanes& planes, const ObscuranceView& view, Buffer<float>& visibility);

 private:
  Lanes lanes_;
  NearField near_field_;
  Buffer<ObscuranceRow> rows_;
  Kernel kernel_;
};

}  // namespace understory
