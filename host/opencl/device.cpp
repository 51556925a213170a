// Lists, chooses and opens devices; sums the times of launches per pass.
#include "host/opencl/device.hpp"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <set>

#include "host/opencl/cache_entries.hpp"
#include "host/opencl/device_impl.hpp"
#include "host/opencl/runtime.hpp"
#include "host/opencl/status.hpp"
#include "sim/error.hpp"

namespace understory {
namespace {

std::string type_name(cl_device_type type) {
  if (type & CL_DEVICE_TYPE_CPU) return "cpu";
  if (type & CL_DEVICE_TYPE_GPU) return "gpu";
  return type & CL_DEVICE_TYPE_ACCELERATOR ? "accelerator" : "other";
}

/// Lanes that `real` (kernels/shared/real.h) can have; a GPU runs one lane per work-item anyway.
int lanes(const cl::Device& device, const std::string& type) {
  const int preferred = static_cast<int>(device.getInfo<CL_DEVICE_PREFERRED_VECTOR_WIDTH_FLOAT>());
  const bool usable = preferred == 4 || preferred == 8 || preferred == 16;
  return type == "cpu" && usable ? preferred : 1;
}

DeviceInfo describe(const cl::Device& device, int index) {
  DeviceInfo info;
  info.index = index;
  info.platform = cl::Platform(device.getInfo<CL_DEVICE_PLATFORM>()).getInfo<CL_PLATFORM_NAME>();
  info.name = device.getInfo<CL_DEVICE_NAME>();
  info.type = type_name(device.getInfo<CL_DEVICE_TYPE>());
  info.version = device.getInfo<CL_DEVICE_VERSION>();
  info.driver = device.getInfo<CL_DRIVER_VERSION>();
  info.compute_units = static_cast<int>(device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>());
  info.memory_mib = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>() >> 20;
  info.max_allocation_mib = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>() >> 20;
  info.max_group = device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>();
  info.vector_width = lanes(device, info.type);
  const std::string extensions = device.getInfo<CL_DEVICE_EXTENSIONS>();
  info.atomic64 = extensions.find("cl_khr_int64_base_atomics") != std::string::npos &&
                  extensions.find("cl_khr_int64_extended_atomics") != std::string::npos;
  return info;
}

std::vector<DeviceInfo> describe_all(const std::vector<cl::Device>& devices) {
  std::vector<DeviceInfo> infos;
  for (const cl::Device& device : devices) infos.push_back(describe(device, static_cast<int>(infos.size())));
  return infos;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

bool matches(const DeviceInfo& info, const std::string& selector) {
  int index = 0;
  const char* end = selector.data() + selector.size();
  const auto [stop, error] = std::from_chars(selector.data(), end, index);
  if (error == std::errc() && stop == end) return info.index == index;
  if (info.type == selector) return true;
  return lower(info.name).find(selector) != std::string::npos ||
         lower(info.platform).find(selector) != std::string::npos;
}

[[noreturn]] void throw_no_device(const std::vector<DeviceInfo>& infos, const std::string& selector) {
  if (infos.empty()) {
    throw Error(ErrorKind::no_device,
                "no OpenCL device: install one, for a CPU on Debian with 'apt install pocl-opencl-icd', and see with "
                "'clinfo -l' whether the loader finds it (OCL_ICD_VENDORS, /etc/OpenCL/vendors)");
  }
  std::string message =
      "no OpenCL device matches '" + selector + "'; allowed are cpu, gpu, an index or part of a name of:";
  for (const DeviceInfo& info : infos) {
    message += "\n  " + std::to_string(info.index) + "  " + info.type + "  " + info.name + "  (" + info.platform + ")";
  }
  throw Error(ErrorKind::no_device, message);
}

std::size_t choose(const std::vector<DeviceInfo>& infos, std::string selector) {
  if (const char* variable = std::getenv("UNDERSTORY_DEVICE"); selector.empty() && variable) selector = variable;
  const auto pick = [&](const std::string& wanted) {
    return std::find_if(infos.begin(), infos.end(),
                        [&](const DeviceInfo& info) { return matches(info, lower(wanted)); });
  };
  auto found = pick(selector.empty() ? "cpu" : selector);
  if (found == infos.end() && selector.empty()) found = infos.begin();
  if (found == infos.end()) throw_no_device(infos, selector);
  return static_cast<std::size_t>(found - infos.begin());
}

/// PoCL keeps its compiler's memory until told otherwise; told while nothing of ours lives, it starts again when
/// needed.
std::atomic<int> live_devices = 0;

double milliseconds(const cl::Event& event) {
  const cl_ulong start = event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
  const cl_ulong end = event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
  return static_cast<double>(end - start) * 1e-6;
}

}  // namespace

std::vector<DeviceInfo> list_devices() { return describe_all(all_devices()); }

Device::Device(const std::string& selector, const std::string& build_options) : impl_(std::make_unique<Impl>()) {
  const std::vector<cl::Device> devices = all_devices();
  const std::vector<DeviceInfo> infos = describe_all(devices);
  const std::size_t chosen = choose(infos, selector);
  impl_->info = infos[chosen];
  impl_->device = devices[chosen];
  impl_->options_of_all = build_options;
  impl_->tuning = read_tuning(tuning_file(impl_->info));
  try {
    impl_->context = cl::Context(impl_->device);
    impl_->queue = cl::CommandQueue(impl_->context, impl_->device, CL_QUEUE_PROFILING_ENABLE);
  } catch (const cl::Error& error) {
    throw Error(ErrorKind::no_device,
                "device '" + impl_->info.name + "' cannot be used: " + error.what() + ": " + status_text(error.err()));
  }
  ++live_devices;
}

Device::~Device() {
  const bool built = !impl_->programs.empty();
  const cl::Platform platform(impl_->device.getInfo<CL_DEVICE_PLATFORM>());
  clFinish(impl_->queue());
  impl_.reset();
  if (--live_devices == 0) clUnloadPlatformCompiler(platform());
  if (!built || runtime_cache_folder().empty()) return;
  try {
    seal_cache(runtime_cache_folder());
  } catch (const std::exception&) {  // the files stay unlisted and are looked at again at the next start
  }
}

const DeviceInfo& Device::info() const { return impl_->info; }

void Device::finish() {
  if (const cl_int status = clFinish(impl_->queue()); status != CL_SUCCESS) {
    throw Error(ErrorKind::unexpected, "device '" + info().name + "' did not finish: " + status_text(status));
  }
}

void Device::Impl::collect_times() {
  for (Launch& launch : launches) {
    launch.event.wait();
    const double ms = milliseconds(launch.event);
    pass_ms[launch.pass] += ms;
    kernel_ms[launch.kernel] += ms;
  }
  launches.clear();
}

void Device::Impl::collect_all_times() {
  try {
    collect_times();
  } catch (const cl::Error& error) {
    throw Error(ErrorKind::unexpected, "a launch failed on device '" + info.name + "': " + status_text(error.err()));
  }
}

void Device::Impl::wait_for_launch(const std::string& pass) {
  if (!last_end) return;
  if (const cl_int status = clFinish(queue()); status != CL_SUCCESS)
    throw Error(ErrorKind::unexpected, "a launch failed on device '" + info.name + "': " + status_text(status));
  const auto now = std::chrono::steady_clock::now();
  host_pass_ms[pass] += std::chrono::duration<double, std::milli>(now - *last_end).count();
  last_end = now;
}

std::map<std::string, double> Device::host_pass_times(const std::function<void()>& action) {
  finish();
  impl_->host_pass_ms.clear();
  impl_->last_end = std::chrono::steady_clock::now();
  try {
    action();
  } catch (...) {
    impl_->last_end.reset();
    throw;
  }
  impl_->last_end.reset();
  return std::exchange(impl_->host_pass_ms, {});
}

std::map<std::string, double> Device::take_pass_times() {
  impl_->collect_all_times();
  impl_->kernel_ms.clear();
  return std::exchange(impl_->pass_ms, {});
}

void Device::use_build_options(const std::string& build_options) { impl_->options_of_all = build_options; }

std::map<std::string, double> Device::take_kernel_times() {
  impl_->collect_all_times();
  impl_->pass_ms.clear();
  return std::exchange(impl_->kernel_ms, {});
}

std::map<std::string, double> Device::build_times() const { return impl_->build_ms; }

std::vector<std::string> Device::programs_built() const {
  std::set<std::string> stems;
  for (const auto& [key, program] : impl_->programs) stems.insert(key.substr(0, key.find(' ')));
  return {stems.begin(), stems.end()};
}

std::vector<std::string> Device::kernels_made() const { return {impl_->kernels.begin(), impl_->kernels.end()}; }
const TuningTable& Device::tuning() const { return impl_->tuning; }
void Device::tune(const std::string& pass, LaunchShape shape) { impl_->tuning[pass] = shape; }

std::uint64_t Device::buffer_bytes() const { return impl_->buffer_bytes; }
std::uint64_t Device::peak_buffer_bytes() const { return impl_->peak_buffer_bytes; }

}  // namespace understory
