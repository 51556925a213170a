// First the answer, then the time, by turns with a stream of as many planes; last which ceiling is near.
#include "bench/kernels.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "bench/energy.hpp"
#include "bench/kernel_cases.hpp"
#include "bench/kernel_costs.hpp"
#include "bench/roofline.hpp"
#include "bench/timing.hpp"

namespace understory {
namespace {

/// "64Ki", "4Mi", or the number itself.
std::string size_text(std::size_t fragments) {
  if (fragments % (1 << 20) == 0) return std::to_string(fragments >> 20) + "Mi";
  if (fragments % (1 << 10) == 0) return std::to_string(fragments >> 10) + "Ki";
  return std::to_string(fragments);
}

/// So many planes of 4 bytes, read and written, in a proportion near that of the cost.
std::pair<int, int> planes_of(const KernelCost& cost) {
  const double largest = std::max({cost.read, cost.written, 1.0}) / 4, scale = std::min(1.0, most_planes / largest);
  const auto planes = [&](double bytes) { return std::max(1, static_cast<int>(std::lround(bytes / 4 * scale))); };
  return {planes(cost.read), planes(cost.written)};
}

/// Small sizes take less time to know as well.
StopRule stop_rule(const BenchOptions& options, bool largest) {
  if (options.repetitions > 0) return exactly(options.repetitions);
  StopRule stop;
  stop.precision = options.precision;
  stop.seconds = largest ? 0.4 : 0.2;
  return stop;
}

void set_times(const MeasuredTime& time, const StopRule& stop, BenchResult& result) {
  result.median_ms = time.device_ms.median;
  result.low_ms = time.device_ms.low;
  result.high_ms = time.device_ms.high;
  result.wall_ms = time.wall_ms.median;
  result.wall_low_ms = time.wall_ms.low;
  result.wall_high_ms = time.wall_ms.high;
  result.runs = time.runs;
  result.noisy = stop.precision > 0 && time.device_ms.half_width() > stop.precision;
}

/// Rates, and the share of each roof: what the kernel's items ask for over what the device could give.
void judge(const KernelCost& cost, double stream_bytes_per_s, const std::map<std::string, double>& roofs,
           BenchResult& result) {
  const double seconds = result.median_ms * 1e-3;
  result.items_per_s = result.items / seconds;
  result.bytes_per_s = (cost.read + cost.written) * result.items_per_s;
  result.flop_per_s = cost.operations * result.items_per_s;
  result.operations_per_byte = cost.operations / (cost.read + cost.written);
  const auto share = [&](const char* roof, const char* limit, double per_item) {
    if (per_item > 0) result.shares[roof] = per_item * result.items_per_s / (roofs.at(limit) * 1e9);
  };
  result.shares["memory"] = result.bytes_per_s / stream_bytes_per_s;
  share("arithmetic", "multiply_add_gflop_per_s", cost.operations);
  share("exp", "exp_g_per_s", cost.exponentials);
  share("gather", "gather_g_per_s", cost.gathers);
  share("atomic", "atomic_g_per_s", cost.atomics);
  const auto nearest = std::max_element(result.shares.begin(), result.shares.end(),
                                        [](const auto& a, const auto& b) { return a.second < b.second; });
  result.bound_by = nearest->first;
  result.roof_share = nearest->second;
  result.streams = cost.streams;
  result.rest = cost.rest;
}

/// Everything of one size.
class SizedKernels {
 public:
  SizedKernels(Device& device, std::size_t fragments, bool largest, const BenchOptions& options, BenchReport& report)
      : device_(device),
        options_(options),
        report_(report),
        fragments_(device, fragments),
        stream_(device, fragments_.planes.padded_fragments),
        suffix_(largest ? "" : "/" + size_text(fragments)),
        largest_(largest) {}

  void measure(const KernelCase& tested, EnergyMeter& energy) {
    BenchResult result;
    result.name = "kernel/" + tested.kernel + suffix_;
    if (options_.progress) options_.progress(result.name);
    const KernelCost& cost = cost_of(tested.kernel);
    const ReadyKernel ready = tested.prepare(device_, fragments_);
    ready.run();
    result.item = cost.item;
    result.items = ready.items;
    result.max_error = ready.error();
    result.verified = result.max_error <= tested.tolerance;
    if (!result.verified) {
      report_.results.push_back(result);
      return;
    }
    const StopRule stop = stop_rule(options_, largest_);
    const auto [read, written] = planes_of(cost);
    const std::vector<MeasuredTime> times =
        time_in_turn(device_, {ready.run, [&, read = read, written = written] { stream_.run(read, written); }}, stop);
    set_times(times[0], stop, result);
    const double stream = 4 * double(stream_.elements()) * (read + written) / (times[1].device_ms.median * 1e-3);
    if (largest_)
      report_.roofs["stream_" + std::to_string(read) + "_" + std::to_string(written) + "_gb_per_s"] = 1e-9 * stream;
    judge(cost, stream, report_.roofs, result);
    result.joules_per_item = energy_of(ready, result, energy);
    report_.results.push_back(result);
    add_functions(times[0], stop, result);
  }

 private:
  /// Counters step every millisecond: a tenth of a second at least.
  double energy_of(const ReadyKernel& ready, const BenchResult& result, EnergyMeter& energy) const {
    if (!energy.readable()) return 0;
    const int runs = std::max(1, static_cast<int>(100 / result.wall_ms));
    energy.start();
    for (int i = 0; i < runs; ++i) ready.run();
    device_.finish();
    return energy.joules() / (runs * ready.items);
  }

  void add_functions(const MeasuredTime& time, const StopRule& stop, const BenchResult& whole) {
    if (time.kernels.size() < 2) return;
    for (const auto& [function, spread] : time.kernels) {
      BenchResult part;
      part.name = whole.name + "/" + function;
      part.item = whole.item;
      part.items = whole.items;
      part.verified = true;
      set_times({spread, {}, {}, time.runs}, stop, part);
      if (spread.median > 0) part.items_per_s = whole.items / (spread.median * 1e-3);
      report_.results.push_back(part);
    }
  }

  Device& device_;
  const BenchOptions& options_;
  BenchReport& report_;
  BenchFragments fragments_;
  PlaneStream stream_;
  std::string suffix_;
  bool largest_;
};

}  // namespace

void bench_kernels(Device& device, const BenchOptions& options, BenchReport& report) {
  std::vector<std::size_t> sizes = options.fragments;
  std::sort(sizes.begin(), sizes.end(), std::greater<>());
  EnergyMeter energy(options.powercap);
  report.energy = energy.description();
  const std::vector<KernelCase> cases = kernel_cases();
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    std::unique_ptr<SizedKernels> sized;  // made for the first kernel that is wanted
    for (const KernelCase& tested : cases) {
      const std::string name = "kernel/" + tested.kernel + (i == 0 ? "" : "/" + size_text(sizes[i]));
      if (name.find(options.filter) == std::string::npos) continue;
      if (report.roofs.empty()) {
        if (options.progress) options.progress("roofs");
        report.roofs = measure_roofs(device, (sizes[0] + 255) / 256 * 256, stop_rule(options, true));
      }
      if (!sized) sized = std::make_unique<SizedKernels>(device, sizes[i], i == 0, options, report);
      sized->measure(tested, energy);
    }
  }
}

}  // namespace understory
