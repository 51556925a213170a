// Kernels of roofline.cl, launched in the shape of the visibility kernels.
#include "bench/roofline.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>

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

Buffer<float> filled(Device& device, std::size_t elements, float value, const char* what) {
  const std::vector<float> values(elements, value);
  return Buffer<float>(device, std::span<const float>(values), what);
}

unsigned lanes(const Device& device) { return static_cast<unsigned>(device.info().vector_width); }

/// Work per second of what `run` launches, by the device's clock.
double rate(Device& device, const std::function<void()>& run, double work, const StopRule& stop) {
  return work / (time_in_turn(device, {run}, stop).front().device_ms.median * 1e-3);
}

void measure_memory(Device& device, std::size_t elements, const StopRule& stop, std::map<std::string, double>& roofs) {
  const auto items = static_cast<unsigned>(elements / lanes(device));
  const std::size_t local = group_fragments / lanes(device);
  const Buffer<float> b = filled(device, elements, 8, "roofline plane"),
                      c = filled(device, elements, 3, "roofline plane");
  const Buffer<float> out(device, elements, "roofline result");
  Kernel copy(device, "roofline", "copy_plane", "copy"), triad(device, "roofline", "triad", "triad");
  const double bytes = 4.0 * static_cast<double>(elements);
  roofs["copy_gb_per_s"] = 1e-9 * rate(
                                      device, [&] { copy.launch(items, 4 * local, b, out, items); }, 2 * bytes, stop);
  verify("copy_plane", out.read(), [](std::size_t) { return 8.0f; });
  roofs["triad_gb_per_s"] =
      1e-9 * rate(
                 device, [&] { triad.launch(items, 4 * local, b, c, 2.0f, out, items); }, 3 * bytes, stop);
  verify("triad", out.read(), [](std::size_t) { return 14.0f; });
}

void measure_arithmetic(Device& device, const StopRule& stop, std::map<std::string, double>& roofs) {
  constexpr unsigned steps = 1024, items = 4096;
  Kernel multiply_add(device, "roofline", "multiply_add", "multiply_add");
  const Buffer<float> sums(device, items, "multiply_add result");
  roofs["multiply_add_gflop_per_s"] =
      1e-9 * rate(
                 device, [&] { multiply_add.launch(items, 64, sums, steps, items); }, 128.0 * steps * items, stop);
  verify("multiply_add", sums.read(), [](std::size_t) { return 2.0f; });

  Kernel exponentials(device, "roofline", "exponentials", "exponentials");
  const Buffer<float> fixed_points(device, std::size_t{items} * lanes(device), "exponentials result");
  roofs["exp_g_per_s"] = 1e-9 * rate(
                                    device, [&] { exponentials.launch(items, 64, fixed_points, steps / 4, items); },
                                    2.0 * (steps / 4) * items * lanes(device), stop);
  verify("exponentials", fixed_points.read(), [](std::size_t) { return 0.56714329f; });
}

void measure_gathers(Device& device, const StopRule& stop, std::map<std::string, double>& roofs) {
  constexpr unsigned steps = 64, items = 4096;
  Kernel gather(device, "roofline", "gather", "gather");
  const Buffer<float> sums(device, std::size_t{items} * lanes(device), "gather result");
  const std::size_t largest = std::min<std::size_t>(64u << 20, std::bit_floor(device.info().max_allocation_mib << 17));
  for (const auto& [name, elements] :
       {std::pair{"gather_g_per_s", std::size_t{1} << 14}, std::pair{"gather_far_g_per_s", largest}}) {
    const Buffer<float> table = filled(device, elements, 1, "gather table");
    const auto mask = static_cast<unsigned>(elements - 1);
    roofs[name] = 1e-9 * rate(
                             device, [&] { gather.launch(items, 64, table, mask, sums, steps, items); },
                             double{steps} * items * lanes(device), stop);
    verify("gather", sums.read(), [](std::size_t) { return float{steps}; });
  }
}

void measure_atomics(Device& device, const StopRule& stop, std::map<std::string, double>& roofs) {
  constexpr unsigned steps = 64, items = 1 << 14, cells = 1 << 19;
  Kernel atomics(device, "roofline", "atomic_minima", "atomic_minima");
  const std::vector<std::uint32_t> highest(2 * cells, 0xffffffffu);
  const Buffer<std::uint32_t> table(device, std::span<const std::uint32_t>(highest), "atomic table");
  roofs["atomic_g_per_s"] = 1e-9 * rate(
                                       device, [&] { atomics.launch(items, 64, table, cells - 1, steps, items); },
                                       double{steps} * items, stop);
  const std::vector<std::uint32_t> after = table.read();
  if (std::count(after.begin(), after.end(), 0xffffffffu) > cells + cells / 2)
    throw Error(ErrorKind::unexpected, "atomic_minima left most of its table as it was");
}

}  // namespace

std::map<std::string, double> measure_roofs(Device& device, std::size_t elements, const StopRule& stop) {
  std::map<std::string, double> roofs;
  measure_memory(device, elements, stop, roofs);
  measure_arithmetic(device, stop, roofs);
  measure_gathers(device, stop, roofs);
  measure_atomics(device, stop, roofs);
  return roofs;
}

PlaneStream::PlaneStream(Device& device, std::size_t elements)
    : device_(&device),
      elements_(elements),
      items_(static_cast<unsigned>(elements / lanes(device))),
      local_size_(4 * group_fragments / lanes(device)) {
  if (elements % group_fragments != 0)
    throw Error(ErrorKind::unexpected, "roofline: " + std::to_string(elements) + " elements are no multiple of " +
                                           std::to_string(group_fragments));
}

void PlaneStream::run(int read, int written) {
  // The planes hold 1, 2, 4, ...
  while (in_.size() < static_cast<std::size_t>(read))
    in_.push_back(filled(*device_, elements_, static_cast<float>(1 << in_.size()), "roofline plane"));
  while (out_.size() < static_cast<std::size_t>(written)) out_.emplace_back(*device_, elements_, "roofline result");
  auto found = kernels_.find({read, written});
  const bool is_new = found == kernels_.end();
  if (is_new) {
    const std::string options = "-DREAD=" + std::to_string(read) + " -DWRITTEN=" + std::to_string(written);
    found =
        kernels_
            .emplace(std::pair(read, written), Kernel(*device_, "roofline", "stream_planes", "stream_planes", options))
            .first;
  }
  // Planes that are not touched take the place of missing ones.
  const auto p = [&](std::size_t i) -> const Buffer<float>& { return in_[std::min(i, in_.size() - 1)]; };
  const auto q = [&](std::size_t i) -> const Buffer<float>& { return out_[std::min(i, out_.size() - 1)]; };
  found->second.launch(items_, local_size_, p(0), p(1), p(2), p(3), p(4), p(5), p(6), p(7), p(8), p(9), p(10), p(11),
                       q(0), q(1), q(2), q(3), q(4), q(5), q(6), q(7), q(8), q(9), q(10), q(11), items_);
  if (is_new)
    verify("stream_planes", q(static_cast<std::size_t>(written) - 1).read(),
           [=](std::size_t) { return static_cast<float>((1 << read) - 1); });
}

}  // namespace understory
