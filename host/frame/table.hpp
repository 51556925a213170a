// A table on the device that is rewritten every frame and grows when it must.
#pragma once
#include <span>
#include <vector>

#include "host/opencl/buffer.hpp"

namespace understory {

template <typename T>
class Table {
 public:
  void write(Device& device, const std::vector<T>& rows, const char* what) {
    if (buffer_.size() < rows.size()) buffer_ = Buffer<T>(device, rows.size(), what);
    if (!rows.empty()) buffer_.write(std::span<const T>(rows));
  }
  const Buffer<T>& buffer() const { return buffer_; }

 private:
  Buffer<T> buffer_;
};

}  // namespace understory
