// What a Device holds. For host/opencl only.
#pragma once
#include <chrono>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "host/opencl/device.hpp"
#include "host/opencl/opencl.hpp"

namespace understory {

struct Device::Impl {
  DeviceInfo info;
  cl::Device device;
  cl::Context context;
  cl::CommandQueue queue;  // in order, profiling
  std::string options_of_all;
  TuningTable tuning;

  std::map<std::string, cl::Program> programs;  // key: stem and options
  std::set<std::string> kernels;                // program/kernel
  struct Launch {
    std::string pass, kernel;
    cl::Event event;
  };
  std::vector<Launch> launches;             // not yet summed
  std::map<std::string, double> pass_ms;    // summed so far
  std::map<std::string, double> kernel_ms;  // the same by kernel function
  std::map<std::string, double> build_ms;   // by stem
  /// While launches are waited for: when the last one ended, and what each pass took on the host's clock so far.
  std::optional<std::chrono::steady_clock::time_point> last_end;
  std::map<std::string, double> host_pass_ms;
  std::uint64_t buffer_bytes = 0, peak_buffer_bytes = 0;

  /// Builds `kernels/<stem>.cl` or finds it built. `options` as given to Kernel.
  cl::Program& program(const std::string& stem, const std::string& options);
  /// All options a program of this device is built with.
  std::string build_options(const std::string& options) const;
  /// After a launch, where launches are waited for: waits, and adds its time on the host's clock to the pass's.
  void wait_for_launch(const std::string& pass);
  /// Waits for the launches noted so far and adds up their times.
  void collect_times();
  /// The same; Error(unexpected) for a launch that failed.
  void collect_all_times();
};

}  // namespace understory
