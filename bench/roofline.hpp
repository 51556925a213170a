// The ceilings of a device, measured in the same run as what is held against them.
#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bench/timing.hpp"
#include "host/opencl/buffer.hpp"
#include "host/opencl/kernel.hpp"

namespace understory {

/// Most planes that a kernel of this project reads, or writes.
inline constexpr int most_planes = 12;

/// copy_gb_per_s, triad_gb_per_s, multiply_add_gflop_per_s, exp_g_per_s (kernels/shared/exp_minus.h), gather_g_per_s
/// (from a table that caches hold) and gather_far_g_per_s (from one of 256 MiB, or what the device has),
/// atomic_g_per_s. 10^9 a second each. `elements` of each plane of the first two, a multiple of 256. Throws
/// Error(unexpected) when one of them computes something wrong.
std::map<std::string, double> measure_roofs(Device& device, std::size_t elements, const StopRule& stop);

/// A kernel that only moves planes: reads some and writes others, in the shape of the visibility kernels.
class PlaneStream {
 public:
  /// Of `elements` floats a plane, a multiple of 256. Throws Error(unexpected) for another number.
  PlaneStream(Device& device, std::size_t elements);

  /// Launches it for 1 to 12 planes read and 1 to 12 written; verifies the first result of each pair.
  void run(int read, int written);
  std::size_t elements() const { return elements_; }

 private:
  Device* device_;
  std::size_t elements_;
  unsigned items_;  // work-items of the device's vector width
  std::size_t local_size_;
  std::vector<Buffer<float>> in_, out_;  // planes that were needed so far
  std::map<std::pair<int, int>, Kernel> kernels_;
};

}  // namespace understory
