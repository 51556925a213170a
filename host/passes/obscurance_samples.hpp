// Sample sets of the obscurance methods: points of the unit disc that stand for lines through the unit ball, and points
// of the ball itself. The tables in obscurance_samples.cpp are written by the program `obscurance_samples`
// (bench/sample_relaxation.hpp).
#pragma once
#include <cstdint>
#include <span>

namespace understory {

struct ObscuranceSample {
  float x, y, z;          // unit ball, z along the view; lines: z = 0
  float constant_share;   // of the ball's volume, that of its Voronoi region; a set's shares sum to 1
  float quadratic_share;  // of the integral of 1 - r^2 over the ball
};

struct ObscuranceSampleSet {
  std::span<const ObscuranceSample> samples;
  bool centre;              // the first sample is the centre
  std::uint64_t seed;       // of the generator
  double deviation, noise;  // bench/sample_relaxation.hpp
};

/// 5, 7, 9, 12, 13, 15, 16, and 1 and 4 for area samples. Throws Error(invalid_input) naming the counts there are.
const ObscuranceSampleSet& line_samples(int count);
/// 6, 12, 33. Throws likewise.
const ObscuranceSampleSet& point_samples(int count);

}  // namespace understory
