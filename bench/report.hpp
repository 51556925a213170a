// What the benchmarks measure and how their results are handed on. `understory bench` prints them.
#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "host/opencl/device.hpp"

namespace understory {

struct BenchOptions {
  std::string device;                                // as --device
  std::string filter;                                // only results whose name contains it; empty: all
  std::size_t fragments = 2048 * 2049;               // of the kernel benchmarks; more than 4 Mi
  int repetitions = 15;                              // of kernels
  std::vector<std::filesystem::path> scenes;         // of the frame benchmarks
  int frames = 12;                                   // warm frames of each scene
  std::function<void(const std::string&)> progress;  // told the name of what comes next; may be empty
};

/// One measured thing. Kernels: `kernel/METHOD`, one item is a fragment. Frames: `frame/SCENE` (an item is a frame) and
/// `frame/SCENE/PASS`.
struct BenchResult {
  std::string name;
  double median_ms = 0, low_ms = 0, high_ms = 0;  // device time of kernels and passes, wall time of frames; warm
  double wall_ms = 0;                             // median on the host's clock; 0: not known
  double cold_ms = 0;                             // wall time of the first run, compiling included; 0: not known
  double items_per_s = 0;
  double bytes_per_s = 0;  // traffic of the planes read and written; 0: not known
  double plane_share = 0;  // speed over that of a kernel that only reads the same planes and writes one
  double roof_share = 0;   // speed over that of the nearest ceiling, both of this run; 0: not known
  std::string bound_by;    // that ceiling, "memory" or "arithmetic"; "latency" if both are far; empty: not known
  double max_error = 0;    // largest deviation from the reference that was seen
  bool verified = false;   // the result was right; nothing else counts when it was not
};

struct BenchReport {
  DeviceInfo device;
  std::map<std::string, double> roofs;  // copy_gb_per_s, read_N_write_1_gb_per_s, multiply_add_gflop_per_s
  std::vector<BenchResult> results;
};

/// Runs all benchmarks that the filter lets through. Throws Error(usage) when there is none.
BenchReport run_bench(const BenchOptions& options);

/// One name in two reports. `ratio` is new over old median; it counts as a change when the intervals do not overlap.
struct BenchChange {
  std::string name;
  double old_ms = 0, new_ms = 0, ratio = 0;
  bool changed = false;
};

/// Names that both hold, in the order of `now`.
std::vector<BenchChange> compare_results(const std::vector<BenchResult>& then, const std::vector<BenchResult>& now);

}  // namespace understory
