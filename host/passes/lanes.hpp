// How many fragments one work-item of a visibility kernel handles, and what follows for a launch.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

#include "host/passes/planes.hpp"

namespace understory {

/// Fragments per work-item: W of kernels/shared/real.h.
class Lanes {
 public:
  /// `count`: 1, 4, 8 or 16; 0: what the device's tuning says of `pass`, else the device's vector width where it is one
  /// of them, else 1 (POCL.md: explicit vectors run up to 20 times as fast on a CPU). Throws Error(unexpected) for
  /// another number.
  Lanes(const Device& device, int count, const std::string& pass = "");

  int count() const { return count_; }
  std::string option() const { return "-DW=" + std::to_string(count_); }
  std::uint32_t items(const FragmentPlanes& planes) const {
    return static_cast<std::uint32_t>(planes.padded_fragments / static_cast<std::size_t>(count_));
  }
  /// Work-items of a group: as tuned, else so many that they handle `blocks` blocks of fragments. Streaming kernels run
  /// up to 1.4 times as fast on four as on one; kernels whose work differs from tile to tile spread better over the
  /// cores on one.
  std::size_t local_size(std::size_t blocks = 4) const {
    const std::size_t fragments = group_ > 0 ? static_cast<std::size_t>(group_) : blocks * fragment_block;
    return std::max<std::size_t>(fragments / static_cast<std::size_t>(count_), 1);
  }

 private:
  int count_;
  int group_ = 0;  // fragments; 0: not tuned
};

}  // namespace understory
