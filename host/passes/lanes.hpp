// How many fragments one work-item of a visibility kernel handles, and what follows for a launch.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

#include "host/passes/planes.hpp"

namespace understory {

/// Fragments per work-item: W of kernels/shared/real.h.
class Lanes {
 public:
  /// `count`: 1, 4, 8 or 16; 0: the device's vector width where it is one of them, else 1 (POCL.md: explicit vectors
  /// run up to 20 times as fast on a CPU). Throws Error(unexpected) for another number.
  Lanes(const Device& device, int count);

  std::string option() const { return "-DW=" + std::to_string(count_); }
  std::uint32_t items(const FragmentPlanes& planes) const {
    return static_cast<std::uint32_t>(planes.padded_fragments / static_cast<std::size_t>(count_));
  }
  /// Work-items of a group: four blocks of fragments. PoCL's code for groups of one block, 16 work-items on a
  /// processor, takes up to half as long again.
  std::size_t local_size() const { return 4 * fragment_block / static_cast<std::size_t>(count_); }

 private:
  int count_;
};

}  // namespace understory
