// The ceilings of a device, measured in the same run as what is held against them.
#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "host/opencl/buffer.hpp"
#include "host/opencl/kernel.hpp"

namespace understory {

/// Most planes that a kernel of this project reads.
inline constexpr int most_planes = 12;

class Roofline {
 public:
  /// Allocates planes of `fragments` floats, a multiple of 256. Throws Error(unexpected) for another number.
  Roofline(Device& device, std::size_t fragments);

  /// Launches a kernel that only reads `planes` planes (1 to 12) and writes one; verifies the first result of each.
  void read_planes(int planes);
  /// The speed of copy_plane and of multiply_add. Each verifies its result: Error(unexpected) when it is wrong.
  double copy_bytes_per_s(int repetitions);
  double multiply_adds_flop_per_s(int repetitions);

 private:
  Device* device_;
  std::size_t fragments_;
  unsigned items_;  // work-items of the device's vector width
  std::size_t local_size_;
  std::vector<Buffer<float>> planes_;
  Buffer<float> out_;
  std::map<int, Kernel> readers_;
};

}  // namespace understory
