// kernels/depth_moments.cl: `depth-moments`, the pyramid of means and variances that area samples of obscurance read.
#pragma once
#include <vector>

#include "host/opencl/kernel.hpp"
#include "host/passes/obscurance.hpp"
#include "kernels/shared/depth_moments.h"

namespace understory {

/// All levels one after the other, finest first; the last is one texel.
struct DepthMoments {
  Buffer<float> mean, variance, coverage;
  std::vector<MomentLevel> levels;
  Buffer<MomentLevel> level_table;
};

class DepthMomentsPass {
 public:
  explicit DepthMomentsPass(Device& device);
  DepthMoments allocate(Device& device, const ObscuranceView& view) const;
  void run(const FragmentPlanes& planes, const ObscuranceView& view, DepthMoments& moments);

 private:
  Kernel take_, halve_;
};

}  // namespace understory
