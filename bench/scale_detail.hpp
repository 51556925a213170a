// What drawing less of a scene saves and changes, beside drawing everything.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "bench/timing.hpp"

namespace understory {

/// Differences of two pictures of one moment, after a box filter of 8 x 8 pixels.
struct FilteredErrors {
  double rmse = 0, bias = 0;  // of V
  double picture_rmse = 0;    // of the sky-lit picture, 0 to 1, all channels
};

struct DetailRow {
  std::string detail;
  Spread95 ms;                // of whole frames, wall
  double triangles = 0;       // drawn; 0: not known
  FilteredErrors one;         // against brute force with the same sample in every pixel
  FilteredErrors many;        // with 16 samples in every pixel
  double largest_change = 0;  // of a slow dolly: between two frames, V of a filtered pixel
  double mean_change = 0;     // of a slow dolly: largest RMS of V between two frames, filtered
  double device_mib = 0;      // buffers
};

/// A row per level of detail, and one named "brute, other samples": what it differs from itself when every sample moves
/// by a third of their distance. `frames` timed.
std::vector<DetailRow> measure_detail(const std::filesystem::path& scene, int frames);

}  // namespace understory
