// Argument checks and launches.
#include "host/opencl/kernel.hpp"

#include <algorithm>

#include "host/opencl/device_impl.hpp"
#include "host/opencl/status.hpp"
#include "sim/error.hpp"

namespace understory {

struct Kernel::Impl {
  Device* device;
  cl::Kernel kernel;
  std::string program, name, pass, options;
  unsigned arguments;              // that the kernel declares
  std::size_t most_local;          // work-items in a group that device and kernel allow
  std::vector<bool> takes_buffer;  // per argument; empty where the device cannot tell

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorKind::unexpected, "kernel " + name + " (kernels/" + program + ".cl) on '" + device->info().name +
                                           "' with '" + options + "': " + what);
  }

  /// "argument 3 (float radius)", as far as the device can tell.
  std::string argument_text(unsigned index) const {
    std::string text = "argument " + std::to_string(index);
    try {
      // The bindings keep the terminating zero of some strings.
      const std::string type = kernel.getArgInfo<CL_KERNEL_ARG_TYPE_NAME>(index).c_str();
      const std::string label = kernel.getArgInfo<CL_KERNEL_ARG_NAME>(index).c_str();
      text += " (" + type + " " + label + ")";
    } catch (const cl::Error&) {
    }
    return text;
  }

  void check_argument(unsigned index, bool buffer) const {
    if (index >= arguments) fail("takes " + std::to_string(arguments) + " arguments, more were given");
    if (!takes_buffer.empty() && takes_buffer[index] != buffer) {
      fail(argument_text(index) + " wants a " + (takes_buffer[index] ? "buffer" : "value") + ", a " +
           (buffer ? "buffer" : "value") + " was given");
    }
  }
};

namespace {

std::vector<bool> buffer_arguments(const cl::Kernel& kernel, unsigned arguments) {
  std::vector<bool> result;
  try {
    for (unsigned index = 0; index < arguments; ++index) {
      const auto space = kernel.getArgInfo<CL_KERNEL_ARG_ADDRESS_QUALIFIER>(index);
      result.push_back(space == CL_KERNEL_ARG_ADDRESS_GLOBAL || space == CL_KERNEL_ARG_ADDRESS_CONSTANT);
    }
  } catch (const cl::Error&) {  // not every device keeps this information
    result.clear();
  }
  return result;
}

}  // namespace

Kernel::Kernel(Device& device, const std::string& program, const std::string& name, const std::string& pass,
               const std::string& options)
    : impl_(std::make_unique<Impl>()) {
  Device::Impl& on = device.impl();
  impl_->device = &device;
  impl_->program = program;
  impl_->name = name;
  impl_->pass = pass;
  impl_->options = on.build_options(options);
  cl::Program& built = on.program(program, options);
  try {
    impl_->kernel = cl::Kernel(built, name.c_str());
    impl_->arguments = impl_->kernel.getInfo<CL_KERNEL_NUM_ARGS>();
    impl_->most_local = impl_->kernel.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(on.device);
  } catch (const cl::Error& error) {
    impl_->fail(std::string(error.what()) + ": " + status_text(error.err()));
  }
  impl_->takes_buffer = buffer_arguments(impl_->kernel, impl_->arguments);
  on.kernels.insert(program + '/' + name);
}

Kernel::~Kernel() = default;
Kernel::Kernel(Kernel&&) noexcept = default;
Kernel& Kernel::operator=(Kernel&&) noexcept = default;

void Kernel::set_buffer(unsigned index, const RawBuffer& buffer) {
  impl_->check_argument(index, true);
  const cl_mem memory = static_cast<cl_mem>(buffer.native());
  const cl_int status = clSetKernelArg(impl_->kernel(), index, sizeof memory, &memory);
  if (status != CL_SUCCESS) impl_->fail(impl_->argument_text(index) + ": " + status_text(status));
}

void Kernel::set_value(unsigned index, const void* value, std::size_t bytes) {
  impl_->check_argument(index, false);
  const cl_int status = clSetKernelArg(impl_->kernel(), index, bytes, value);
  if (status != CL_SUCCESS) {
    impl_->fail(impl_->argument_text(index) + " was given " + std::to_string(bytes) + " bytes: " + status_text(status));
  }
}

void Kernel::enqueue(std::size_t first, std::size_t items, std::size_t local, unsigned arguments) {
  if (arguments != impl_->arguments) {
    impl_->fail("takes " + std::to_string(impl_->arguments) + " arguments, " + std::to_string(arguments) +
                " were given");
  }
  if (items == 0) return;
  constexpr std::size_t usual_local = 256, most_pending = 4096;
  local = std::clamp<std::size_t>(local == 0 ? usual_local : local, 1, impl_->most_local);
  const std::size_t global = (items + local - 1) / local * local;
  Device::Impl& on = impl_->device->impl();
  cl::Event event;
  const cl_int status =
      clEnqueueNDRangeKernel(on.queue(), impl_->kernel(), 1, &first, &global, &local, 0, nullptr, &event());
  if (status != CL_SUCCESS) {
    impl_->fail("launch of " + std::to_string(global) + " work-items in groups of " + std::to_string(local) +
                " failed: " + status_text(status));
  }
  on.launches.push_back({impl_->pass, impl_->name, std::move(event)});
  on.wait_for_launch(impl_->pass);
  if (on.launches.size() > most_pending) on.collect_times();
}

}  // namespace understory
