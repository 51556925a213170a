// What there is to measure: every kernel with data to run on and the right answer. What it costs stands in
// kernel_costs.hpp, under the same name.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "bench/fragments.hpp"

namespace understory {

/// A kernel at one size, on one device.
struct ReadyKernel {
  std::function<void()> run;      // launches it; any number of times
  std::function<double()> error;  // largest deviation of the last run from the right answer; infinity: not finite
  double items = 0;               // of its cost, per run
};

struct KernelCase {
  std::string kernel;    // one of kernel_costs()
  double tolerance = 0;  // largest error that is right
  /// Builds the kernel for about as many items as there are fragments, which must outlive what it returns.
  std::function<ReadyKernel(Device&, BenchFragments&)> prepare;
};

std::vector<KernelCase> kernel_cases();

/// A visibility pass: `build` makes what shades all fragments into the plane, `reference` is V. Fragments other than
/// `filled_by` crowns are made for it.
KernelCase visibility_case(
    const std::string& kernel, double tolerance,
    std::function<std::function<void()>(Device&, BenchFragments&, Buffer<float>& visibility)> build,
    std::function<double(const BenchFragments&, const BenchFragment&)> reference,
    BenchFragments::Cover filled_by = BenchFragments::Cover::crowns);

/// In files of their own, for what they need beside the fragments.
KernelCase crown_baked_case();
KernelCase crown_field_case();
KernelCase environment_case();
KernelCase farthest_depth_case();
KernelCase grass_transmittance_case();
/// grid, or grid-cone with rule multiply.
KernelCase grid_case(const std::string& method);
/// Posing, drawing and resolving of triangles.
std::vector<KernelCase> geometry_cases();
/// Posing and drawing of blades and far pieces.
std::vector<KernelCase> foliage_cases();
/// Obscurance and what else reads an image's neighbourhood.
std::vector<KernelCase> image_cases();

}  // namespace understory
