// kernels/tile_grids.cl: which occlusion grids each tile of fragments may lie in. First half of `grid` and `grid-cone`.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "host/opencl/kernel.hpp"
#include "host/passes/planes.hpp"
#include "kernels/shared/grid_record.h"

namespace understory {

/// Occlusion grids on the device: the samples of all bodies, and where each body is this frame.
class GridTable {
 public:
  /// `samples`: packed grids one after the other (packed_share or packed_cone of sim/occlusion_grid.hpp).
  GridTable(Device& device, std::span<const std::uint8_t> samples);
  /// `records`: one per body, in the order that combining rules go through them.
  void place(const std::vector<GridRecord>& records);

  const Buffer<std::uint8_t>& samples() const { return samples_; }
  const Buffer<GridRecord>& records() const { return records_; }
  const Buffer<float>& bounds() const { return bounds_; }  // 6 planes of `padded` numbers: low x, y, z, high x, y, z
  std::uint32_t count() const { return count_; }
  std::uint32_t padded() const { return padded_; }

 private:
  Device* device_;
  Buffer<std::uint8_t> samples_;
  Buffer<GridRecord> records_;
  Buffer<float> bounds_;
  std::uint32_t count_ = 0, padded_ = 0;
};

class TileGridsPass {
 public:
  /// `pass`: whose time it counts as.
  TileGridsPass(Device& device, const std::string& pass);
  void run(const FragmentPlanes& planes, const GridTable& grids);

  const Buffer<std::uint32_t>& listed() const { return listed_; }  // per tile, or ALL_GRIDS
  const Buffer<std::uint32_t>& lists() const { return lists_; }    // `capacity` per tile
  std::uint32_t capacity() const { return capacity_; }

 private:
  Device* device_;
  Kernel kernel_;
  Buffer<std::uint32_t> listed_, lists_;
  std::uint32_t capacity_ = 0;
};

}  // namespace understory
