// What the benchmarks measure and how their results are handed on. `understory bench` prints them.
#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "host/opencl/device.hpp"

namespace understory {

struct BenchOptions {
  std::string device;                                                // as --device
  std::string filter;                                                // only results whose name contains it; empty: all
  std::vector<std::size_t> fragments = {1 << 16, 1 << 19, 1 << 22};  // sizes of the kernel benchmarks
  int repetitions = 0;                                               // of kernels; 0: until `precision` is reached
  double precision = 0.02;                                           // half an interval over its median
  std::vector<std::filesystem::path> scenes;                         // of the frame benchmarks
  int frames = 12;                                                   // warm frames of each scene
  std::filesystem::path powercap = "/sys/class/powercap";            // where Linux shows RAPL's counters
  std::function<void(const std::string&)> progress;                  // told the name of what comes next; may be empty
};

/// How long a program takes before its first result, ms of wall time.
struct BuildTimes {
  double build_ms = 0;         // clBuildProgram and kernel creation
  double first_launch_ms = 0;  // the first run until it has finished: some devices compile for it
  double items = 0;            // of that run
};

/// One measured thing. Kernels: `kernel/NAME` at the largest size, `kernel/NAME/SIZE` at smaller ones, and
/// `kernel/NAME/FUNCTION` where several kernel functions make it up. Frames: `frame/SCENE` (an item is a frame) and
/// `frame/SCENE/PASS`.
struct BenchResult {
  std::string name;
  std::string item;                               // what is counted: fragment, triangle, ...; empty: see `name`
  double items = 0;                               // per run; 0: not known
  double median_ms = 0, low_ms = 0, high_ms = 0;  // device time of kernels and passes, wall time of frames; warm
  double wall_ms = 0, wall_low_ms = 0, wall_high_ms = 0;  // on the host's clock; 0: not known
  int runs = 0;                                           // that the interval is made of; 0: not known
  bool noisy = false;  // the interval stayed wider than asked for: the machine did something else as well
  double cold_ms = 0;  // frames: wall time of the first, compiling included; 0: not known
  std::optional<BuildTimes> cold, warm;  // with an empty and with a filled cache of compiled kernels
  double items_per_s = 0;
  double bytes_per_s = 0;                // of what has to move (kernel_costs.hpp); 0: not known
  double flop_per_s = 0;                 // 0: not known
  double operations_per_byte = 0;        // place under the roof
  double joules_per_item = 0;            // of the whole package; 0: not readable
  std::map<std::string, double> shares;  // by roof: memory, arithmetic, exp, gather, atomic
  double roof_share = 0;                 // the largest of them; 0: not known
  std::string bound_by;                  // the roof it belongs to
  bool streams = false;                  // held to 0.8 of the memory roof
  std::string rest;                      // what keeps it from its roof
  double max_error = 0;                  // largest deviation from the right answer that was seen
  bool verified = false;                 // the result was right; nothing else counts when it was not
};

struct BenchReport {
  DeviceInfo device;
  std::map<std::string, double> roofs;  // roofline.hpp, and stream_READ_WRITTEN_gb_per_s at the largest size
  std::string energy;                   // where joules come from, or why there are none
  std::vector<BenchResult> results;
};

/// Runs all benchmarks that the filter lets through. Throws Error(usage) when there is none.
BenchReport run_bench(const BenchOptions& options);

/// Kernels that the filter lets through are built and launched once each, on few fragments; by name as in a report.
/// `told` hears of each when it is built, with null, and with its times when it has run.
void time_builds(const BenchOptions& options,
                 const std::function<void(const std::string& name, const BuildTimes* times)>& told);

/// Verdict on one name in two reports. `low` and `high` enclose new over old time.
struct BenchChange {
  enum class Verdict { faster, slower, same, undecided };
  std::string name;
  double old_ms = 0, new_ms = 0, ratio = 0, low = 0, high = 0;
  Verdict verdict = Verdict::undecided;
};

/// Up to this share two times count as the same.
inline constexpr double same_within = 0.05;

std::string verdict_name(BenchChange::Verdict verdict);

/// Names that both hold, in the order of `now`. Faster, slower: the intervals do not overlap and the medians differ by
/// more than `same_within`; same: the whole interval of the ratio is within it; else undecided.
std::vector<BenchChange> compare_results(const std::vector<BenchResult>& then, const std::vector<BenchResult>& now);

}  // namespace understory
