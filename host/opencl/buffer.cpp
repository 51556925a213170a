// Allocation with the limits in the message, transfers within bounds, and mappings.
#include "host/opencl/buffer.hpp"

#include <algorithm>
#include <utility>

#include "host/opencl/device_impl.hpp"
#include "host/opencl/status.hpp"
#include "sim/error.hpp"

namespace understory {
namespace {

std::string mebibytes(std::size_t bytes) { return std::to_string((bytes + (1 << 20) - 1) >> 20) + " MiB"; }

void check(cl_int status, const char* action, std::size_t bytes, const Device& device) {
  if (status == CL_SUCCESS) return;
  throw Error(ErrorKind::unexpected, std::string(action) + " of " + std::to_string(bytes) +
                                         " bytes failed on device '" + device.info().name +
                                         "': " + status_text(status));
}

void check_range(const char* action, std::size_t bytes, std::size_t offset, std::size_t size) {
  if (offset <= size && bytes <= size - offset) return;
  throw Error(ErrorKind::unexpected, std::string(action) + " of " + std::to_string(bytes) + " bytes at offset " +
                                         std::to_string(offset) + " passes the end of a buffer of " +
                                         std::to_string(size) + " bytes");
}

/// Bytes of memory after every buffer: kernels/shared/obscurance_row.h reads seven floats from the last four of a plane
/// on.
constexpr std::size_t read_past_end = 16;

}  // namespace

RawBuffer::RawBuffer(Device& device, std::size_t bytes, const char* what) : device_(&device), bytes_(bytes) {
  if (bytes == 0) return;  // OpenCL has no empty buffers: kernels get a null pointer
  Device::Impl& impl = device.impl();
  const DeviceInfo& info = impl.info;
  cl_int status = CL_MEM_OBJECT_ALLOCATION_FAILURE;
  const bool fits = bytes >> 20 <= info.max_allocation_mib && (impl.buffer_bytes + bytes) >> 20 <= info.memory_mib;
  if (fits) memory_ = clCreateBuffer(impl.context(), CL_MEM_READ_WRITE, bytes + read_past_end, nullptr, &status);
  if (status != CL_SUCCESS) {
    throw Error(ErrorKind::invalid_input, std::string(what) + " needs " + mebibytes(bytes) + " on device '" +
                                              info.name + "', which allows " + std::to_string(info.max_allocation_mib) +
                                              " MiB at once and " + std::to_string(info.memory_mib) + " MiB in all, " +
                                              mebibytes(impl.buffer_bytes) + " of them in use: " + status_text(status));
  }
  impl.buffer_bytes += bytes;
  impl.peak_buffer_bytes = std::max(impl.peak_buffer_bytes, impl.buffer_bytes);
}

RawBuffer::~RawBuffer() {
  if (!memory_) return;
  device_->impl().buffer_bytes -= bytes_;
  clReleaseMemObject(static_cast<cl_mem>(memory_));
}

RawBuffer::RawBuffer(RawBuffer&& other) noexcept
    : device_(std::exchange(other.device_, nullptr)),
      memory_(std::exchange(other.memory_, nullptr)),
      bytes_(std::exchange(other.bytes_, 0)) {}

RawBuffer& RawBuffer::operator=(RawBuffer&& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(memory_, other.memory_);
  std::swap(bytes_, other.bytes_);
  return *this;
}

void RawBuffer::write(const void* data, std::size_t bytes, std::size_t offset, bool wait) {
  check_range("writing", bytes, offset, bytes_);
  if (bytes == 0) return;
  cl_command_queue queue = device_->impl().queue();
  check(clEnqueueWriteBuffer(queue, static_cast<cl_mem>(memory_), wait ? CL_TRUE : CL_FALSE, offset, bytes, data, 0,
                             nullptr, nullptr),
        "writing", bytes, *device_);
}

void RawBuffer::read(void* data, std::size_t bytes, std::size_t offset) const {
  check_range("reading", bytes, offset, bytes_);
  if (bytes == 0) return;
  cl_command_queue queue = device_->impl().queue();
  check(clEnqueueReadBuffer(queue, static_cast<cl_mem>(memory_), CL_TRUE, offset, bytes, data, 0, nullptr, nullptr),
        "reading", bytes, *device_);
}

RawMapping::RawMapping(const RawBuffer& buffer) : buffer_(&buffer) {
  if (buffer.bytes() == 0) return;
  cl_event ready = nullptr;
  cl_int status = CL_SUCCESS;
  data_ = clEnqueueMapBuffer(buffer.device()->impl().queue(), static_cast<cl_mem>(buffer.native()), CL_FALSE,
                             CL_MAP_READ, 0, buffer.bytes(), 0, nullptr, &ready, &status);
  check(status, "mapping", buffer.bytes(), *buffer.device());
  ready_ = ready;
}

RawMapping::~RawMapping() {
  if (ready_) clReleaseEvent(static_cast<cl_event>(ready_));
  if (!data_) return;
  clEnqueueUnmapMemObject(buffer_->device()->impl().queue(), static_cast<cl_mem>(buffer_->native()), data_, 0, nullptr,
                          nullptr);
}

RawMapping::RawMapping(RawMapping&& other) noexcept
    : buffer_(std::exchange(other.buffer_, nullptr)),
      ready_(std::exchange(other.ready_, nullptr)),
      data_(std::exchange(other.data_, nullptr)) {}

RawMapping& RawMapping::operator=(RawMapping&& other) noexcept {
  std::swap(buffer_, other.buffer_);
  std::swap(ready_, other.ready_);
  std::swap(data_, other.data_);
  return *this;
}

const void* RawMapping::data() const {
  if (!ready_) return data_;
  const cl_event ready = static_cast<cl_event>(ready_);
  check(clWaitForEvents(1, &ready), "mapping", buffer_->bytes(), *buffer_->device());
  return data_;
}

}  // namespace understory
