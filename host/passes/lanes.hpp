// How many fragments one work-item of a visibility kernel handles, and what follows for a launch.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

#include "host/passes/planes.hpp"

namespace understory {

/// Fragments per work-item: W of kernels/shared/real.h; 1, 4, 8 or 16. Kernels without an inner loop are vectorised
/// across work-items by the device, best at 1; those with one want the device's vector width (POCL.md).
class Lanes {
 public:
  /// Throws Error(unexpected) unless `count` is 1, 4, 8 or 16.
  explicit Lanes(int count);
  /// For a kernel with an inner loop: the device's vector width, or 1 where that is no width of ours.
  static Lanes of_device(const Device& device);

  std::string option() const { return "-DW=" + std::to_string(count_); }
  std::uint32_t items(const FragmentPlanes& planes) const {
    return static_cast<std::uint32_t>(planes.padded_fragments / static_cast<std::size_t>(count_));
  }
  /// A work-group handles one block of fragments.
  std::size_t local_size() const { return fragment_block / static_cast<std::size_t>(count_); }

 private:
  int count_;
};

}  // namespace understory
