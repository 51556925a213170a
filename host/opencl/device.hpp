// An OpenCL device with its context and one in-order profiling queue. OpenCL headers stay in host/opencl.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "host/opencl/tuning.hpp"

namespace understory {

struct DeviceInfo {
  int index = 0;                              // over all platforms, as `--device` counts
  std::string platform, name, type, version;  // type: cpu, gpu, accelerator
  std::string driver;
  int compute_units = 0;
  std::uint64_t memory_mib = 0, max_allocation_mib = 0;
  std::uint64_t max_group = 0;  // work-items
  int vector_width = 1;         // preferred float lanes: the W that kernels are built with (1 on a GPU)
  bool atomic64 = false;        // cl_khr_int64_extended_atomics (and base)
};

/// Every device of every platform, in a stable order. Empty when there is none. Never throws for want of a device.
std::vector<DeviceInfo> list_devices();

class Device {
 public:
  /// `selector`: empty, an index, "cpu", "gpu", or part of a platform or device name; empty falls back to the
  /// variable UNDERSTORY_DEVICE, then the first CPU, then the first device.
  /// `build_options`: for every program of this device, before its own; for measuring what they change.
  /// Throws Error(no_device) with the list of what there is, or how to install PoCL when there is nothing.
  explicit Device(const std::string& selector = "", const std::string& build_options = "");
  /// `build_options` for programs built from now on.
  void use_build_options(const std::string& build_options);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  const DeviceInfo& info() const;
  void finish();
  /// Waits for all launches; milliseconds of device time per pass name since the last call, summed over launches.
  std::map<std::string, double> take_pass_times();
  /// The same per kernel function. Either call forgets the times of both.
  std::map<std::string, double> take_kernel_times();
  /// Runs `action` with every launch waited for, and returns milliseconds of the host's clock per pass name: from the
  /// end of the launch before it, or the call, to its own end, with what the host does for it in between. The sum is
  /// the wall time of the action but for what comes after its last launch.
  std::map<std::string, double> host_pass_times(const std::function<void()>& action);
  /// Wall milliseconds that building each program took so far, by stem, summed over its options.
  std::map<std::string, double> build_times() const;
  /// Names of the programs built so far on this device (stems of .cl files), sorted.
  std::vector<std::string> programs_built() const;
  /// "program/kernel" of every kernel made so far, sorted.
  std::vector<std::string> kernels_made() const;
  /// Bytes of live buffers, and the most there ever were.
  std::uint64_t buffer_bytes() const;
  std::uint64_t peak_buffer_bytes() const;

  /// How passes made from now on are launched; at first what the device's tuning file says.
  const TuningTable& tuning() const;
  void tune(const std::string& pass, LaunchShape shape);

  struct Impl;  // for host/opencl only
  Impl& impl() { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace understory
