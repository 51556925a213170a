// Kernels of roofline.cl, launched in the shape of the visibility kernels.
#include "bench/roofline.hpp"

#include <algorithm>
#include <cmath>

#include "bench/timing.hpp"
#include "sim/error.hpp"

namespace understory {
namespace {

constexpr std::size_t group_fragments = 256;

/// Throws unless every 97th element of `plane` is what `expected` says.
template <typename Expected>
void verify(const char* what, const std::vector<float>& plane, Expected expected) {
  for (std::size_t i = 0; i < plane.size(); i += 97) {
    if (std::abs(plane[i] - expected(i)) <= 1e-6f * std::abs(expected(i))) continue;
    throw Error(ErrorKind::unexpected, std::string(what) + " is wrong at element " + std::to_string(i) + ": " +
                                           std::to_string(plane[i]) + ", not " + std::to_string(expected(i)));
  }
}

}  // namespace

Roofline::Roofline(Device& device, std::size_t fragments)
    : device_(&device),
      fragments_(fragments),
      items_(static_cast<unsigned>(fragments / static_cast<std::size_t>(device.info().vector_width))),
      local_size_(group_fragments / static_cast<std::size_t>(device.info().vector_width)),
      out_(device, fragments, "roofline result") {
  if (fragments % group_fragments != 0)
    throw Error(ErrorKind::unexpected, "roofline: " + std::to_string(fragments) + " fragments are no multiple of " +
                                           std::to_string(group_fragments));
  std::vector<float> values(fragments);
  for (int plane = 0; plane < most_planes; ++plane) {
    std::fill(values.begin(), values.end(), static_cast<float>(1 << plane));
    planes_.emplace_back(device, std::span<const float>(values), "roofline plane");
  }
}

void Roofline::read_planes(int planes) {
  const auto& p = planes_;
  auto found = readers_.find(planes);
  const bool is_new = found == readers_.end();
  if (is_new) {
    const std::string count = std::to_string(planes);
    found = readers_.emplace(planes, Kernel(*device_, "roofline", "read_planes", "read_" + count, "-DPLANES=" + count))
                .first;
  }
  found->second.launch(items_, local_size_, p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8], p[9], p[10], p[11],
                       out_, items_);
  // The planes hold 1, 2, 4, ...
  if (is_new) verify("read_planes", out_.read(), [=](std::size_t) { return static_cast<float>((1 << planes) - 1); });
}

double Roofline::copy_bytes_per_s(int repetitions) {
  Kernel copy(*device_, "roofline", "copy_plane", "copy");
  const auto run = [&] { copy.launch(items_, local_size_, planes_[3], out_, items_); };
  const MeasuredTime time = time_in_turn(*device_, {run}, repetitions).front();
  verify("copy_plane", out_.read(), [](std::size_t) { return 8.0f; });
  return 8.0 * static_cast<double>(fragments_) / (time.device_ms.median * 1e-3);
}

double Roofline::multiply_adds_flop_per_s(int repetitions) {
  constexpr unsigned steps = 2048;
  const std::size_t items = std::min<std::size_t>(fragments_, 4096);
  Kernel kernel(*device_, "roofline", "multiply_add", "multiply_add");
  Buffer<float> result(*device_, items, "multiply_add result");
  const auto run = [&] { kernel.launch(items, 64, result, steps, static_cast<unsigned>(items)); };
  const MeasuredTime time = time_in_turn(*device_, {run}, repetitions).front();
  verify("multiply_add", result.read(), [](std::size_t) { return 2.0f; });
  return 128.0 * steps * static_cast<double>(items) / (time.device_ms.median * 1e-3);
}

}  // namespace understory
