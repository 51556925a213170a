// A kernel of an embedded program: arguments in order, by value or by buffer, checked in number and size at launch.
#pragma once
#include <array>
#include <cstddef>
#include <string>
#include <type_traits>

#include "host/opencl/buffer.hpp"
#include "host/opencl/device.hpp"

namespace understory {

class Kernel {
 public:
  Kernel() = default;
  /// Builds `kernels/<program>.cl` (once per device and options) and takes `name` from it. `pass` names it in timings.
  /// Every program is built with -DW=<vector width> first; later -D options override it.
  /// Throws Error(unexpected) with kernel, device, options and the compiler's log.
  Kernel(Device& device, const std::string& program, const std::string& name, const std::string& pass,
         const std::string& options = "");
  ~Kernel();
  Kernel(Kernel&&) noexcept;
  Kernel& operator=(Kernel&&) noexcept;

  /// Enqueues `items` work-items, rounded up to a multiple of `local`: kernels guard against the surplus. `local` 0
  /// means 256; more than the device or the kernel allows is cut to that. No items: nothing is launched. Arguments are
  /// Buffer<T> or plain values of the exact size the kernel declares.
  template <typename... Args>
  void launch(std::size_t items, std::size_t local, const Args&... args) {
    launch_from(0, items, local, args...);
  }
  /// The same for work-items `first` up to `first` + `items`.
  template <typename... Args>
  void launch_from(std::size_t first, std::size_t items, std::size_t local, const Args&... args) {
    unsigned index = 0;
    (set(index++, args), ...);
    enqueue(first, items, local, index);
  }

 private:
  template <typename T>
  void set(unsigned index, const Buffer<T>& buffer) {
    set_buffer(index, buffer.raw());
  }
  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void set(unsigned index, const T& value) { set_value(index, &value, sizeof(T)); }
  void set_buffer(unsigned index, const RawBuffer& buffer);
  void set_value(unsigned index, const void* value, std::size_t bytes);
  void enqueue(std::size_t first, std::size_t items, std::size_t local, unsigned arguments);

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace understory
