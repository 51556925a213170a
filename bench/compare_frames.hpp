// Two images of visibility of the same fragments, pixel by pixel: what `understory compare` tells.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "bench/error_statistics.hpp"
#include "sim/frame.hpp"

namespace understory {

struct FrameComparison {
  ErrorStatistics all;
  double ssim = 1;                                 // mean over the compared pixels
  std::map<std::string, ErrorStatistics> classes;  // by owner class, of those that occur
  std::size_t mismatched = 0;                      // pixels left out because the frames see different things there
  Plane difference;                                // value - reference; 0 where nothing is compared
  std::vector<std::uint32_t> validity;             // background where nothing is compared
};

/// frame.visibility of both; the reference's halfwidth and rays if it is a truth. Background of either is left out, and
/// so are pixels whose owners differ, as on edges seen by another device. Throws Error(invalid_input) when sizes or
/// owner tables differ, or more than 1 % of the pixels do.
FrameComparison compare_frames(const Frame& value, const Frame& reference);

}  // namespace understory
