// Recorded motion of the rigid parts of an occluder: a pose per part and instant, interpolated, repeated for ever.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "sim/path.hpp"
#include "sim/scene.hpp"

namespace understory {

struct MotionRecord {
  struct Track {
    std::string part;
    std::vector<double> times;     // s, increasing
    std::vector<Transform> poses;  // part to body, z up; as many as times
  };
  std::filesystem::path file;
  std::vector<Track> tracks;
  double start = 0, period = 0;  // s

  /// Null when the record has no such part.
  const Track* find(const std::string& part) const;
  /// Linear in position, along the shorter arc in rotation; periodic. A last pose that differs from the first is led
  /// back to it over one more step of mean duration. Throws Error(invalid_input) naming the parts there are.
  Transform at(const std::string& part, double time) const;
};

/// Reads a CSV with the header `time_s,part,m00,m01,...,m23`: row-major 3x4 part-to-body matrices, metres. `up` is the
/// axis of the file; y up becomes z up by (x, y, z) -> (x, -z, y). Throws Error naming file, line, column and value for
/// what is missing, no number, no rotation (orthonormal within 1e-3), or out of order.
MotionRecord read_motion_record(const std::filesystem::path& file, UpAxis up);

}  // namespace understory
