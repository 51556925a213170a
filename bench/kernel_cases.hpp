// What there is to measure: every visibility method with its traffic, its arithmetic and the right answer.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "bench/fragments.hpp"

namespace understory {

struct KernelCase {
  std::string method;
  int planes_read, planes_written;  // per launch, of 4 bytes a fragment; tables stay in the cache
  double flops;                     // per fragment, counted in the source, fma as 2, division and root as 1; 0: varies
  double tolerance;                 // largest deviation from `reference`
  /// Builds the pass; each call of what it returns shades all fragments into the plane.
  std::function<std::function<void()>(Device&, BenchFragments&, Buffer<float>& visibility)> build;
  std::function<double(const BenchFragments&, const BenchFragment&)> reference;  // V
};

std::vector<KernelCase> kernel_cases();
/// In files of their own, for what they need beside the fragments.
KernelCase crown_baked_case();
KernelCase crown_field_case();
KernelCase environment_case();
KernelCase grass_transmittance_case();
/// grid, or grid-cone with rule multiply.
KernelCase grid_case(const std::string& method);

}  // namespace understory
