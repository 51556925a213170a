// Device memory of `count` elements of T, owned. Sizes are checked, and named in the message when they do not fit.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "host/opencl/device.hpp"

namespace understory {

/// Untyped part of Buffer; move-only.
class RawBuffer {
 public:
  RawBuffer() = default;
  /// Uninitialised; of 0 bytes: kernels get a null pointer. Throws Error(invalid_input) naming `what`, the bytes asked
  /// for and the device's limits.
  RawBuffer(Device& device, std::size_t bytes, const char* what);
  ~RawBuffer();
  RawBuffer(RawBuffer&& other) noexcept;
  RawBuffer& operator=(RawBuffer&& other) noexcept;

  /// `wait` false: returns at once; `data` must stay as it is until something later on this device was waited for.
  void write(const void* data, std::size_t bytes, std::size_t offset = 0, bool wait = true);
  void read(void* data, std::size_t bytes, std::size_t offset = 0) const;  // blocking
  std::size_t bytes() const { return bytes_; }
  void* native() const { return memory_; }  // cl_mem, for host/opencl only
  Device* device() const { return device_; }

 private:
  Device* device_ = nullptr;
  void* memory_ = nullptr;
  std::size_t bytes_ = 0;
};

/// A whole buffer as the host can read it: where device and host share memory nothing is copied. Asked for and given
/// back in the thread that launches kernels, and given back before a later launch writes to the buffer.
class RawMapping {
 public:
  RawMapping() = default;
  explicit RawMapping(const RawBuffer& buffer);  // returns at once
  ~RawMapping();
  RawMapping(RawMapping&& other) noexcept;
  RawMapping& operator=(RawMapping&& other) noexcept;
  /// Waits until all that was launched before is done.
  const void* data() const;

 private:
  const RawBuffer* buffer_ = nullptr;
  void* ready_ = nullptr;  // cl_event
  void* data_ = nullptr;
};

template <typename T>
class Buffer {
 public:
  Buffer() = default;
  Buffer(Device& device, std::size_t count, const char* what) : raw_(device, count * sizeof(T), what), count_(count) {}
  Buffer(Device& device, std::span<const T> data, const char* what) : Buffer(device, data.size(), what) { write(data); }

  /// From element `first` on. `wait`: as RawBuffer::write.
  void write(std::span<const T> data, bool wait = true, std::size_t first = 0) {
    raw_.write(data.data(), data.size_bytes(), first * sizeof(T), wait);
  }
  void read(std::span<T> data) const { raw_.read(data.data(), data.size_bytes()); }
  std::vector<T> read() const {
    std::vector<T> data(count_);
    read(std::span<T>(data));
    return data;
  }
  std::size_t size() const { return count_; }
  const RawBuffer& raw() const { return raw_; }

 private:
  RawBuffer raw_;
  std::size_t count_ = 0;
};

}  // namespace understory
