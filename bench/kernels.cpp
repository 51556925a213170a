// First the answer, then the time, by turns with the plane reader; last which ceiling is near.
#include "bench/kernels.hpp"

#include <algorithm>
#include <cmath>

#include "bench/kernel_cases.hpp"
#include "bench/roofline.hpp"
#include "bench/timing.hpp"

namespace understory {
namespace {

/// Largest deviation over every 101st fragment; infinity for anything that is not finite.
double largest_error(const KernelCase& tested, const BenchFragments& all, const std::vector<float>& visibility) {
  double largest = 0;
  for (std::size_t i = 0; i < all.planes.fragments; i += 101) {
    const double error = std::abs(double(visibility[i]) - tested.reference(all, all.at(i)));
    largest = std::isfinite(error) ? std::max(largest, error) : HUGE_VAL;
  }
  return largest;
}

/// Which ceiling is nearest, and how near. Neither within half: something else holds the kernel up, such as gathers.
void judge(BenchResult& result, double memory_share, double arithmetic_share) {
  result.roof_share = std::max(memory_share, arithmetic_share);
  result.bound_by = memory_share >= arithmetic_share ? "memory" : "arithmetic";
  if (result.roof_share < 0.5) result.bound_by = "latency";
}

BenchResult measure(Device& device, const KernelCase& tested, BenchFragments& all, Roofline& roofline,
                    const BenchOptions& options, BenchReport& report) {
  Buffer<float> visibility(device, all.planes.padded_fragments, "visibility");
  BenchResult result;
  result.name = "kernel/" + tested.method;
  std::function<void()> shade;
  result.cold_ms = wall_milliseconds(device, [&] {
    shade = tested.build(device, all, visibility);
    shade();
  });
  result.max_error = largest_error(tested, all, visibility.read());
  result.verified = result.max_error <= tested.tolerance;
  if (!result.verified) return result;

  const auto read = [&] { roofline.read_planes(tested.planes_read); };
  const std::vector<MeasuredTime> times = time_in_turn(device, {shade, read}, options.repetitions);
  const double fragments = static_cast<double>(all.planes.padded_fragments);
  const double seconds = times[0].device_ms.median * 1e-3, roof_seconds = times[1].device_ms.median * 1e-3;
  result.median_ms = times[0].device_ms.median;
  result.low_ms = times[0].device_ms.low;
  result.high_ms = times[0].device_ms.high;
  result.wall_ms = times[0].wall_ms.median;
  result.items_per_s = fragments / seconds;
  result.bytes_per_s = 4 * fragments * (tested.planes_read + tested.planes_written) / seconds;
  result.plane_share = roof_seconds / seconds;
  const std::string roof = "read_" + std::to_string(tested.planes_read) + "_write_1_gb_per_s";
  report.roofs[roof] = 4e-9 * fragments * (tested.planes_read + 1) / roof_seconds;
  judge(result, result.plane_share,
        tested.flops * result.items_per_s / (report.roofs.at("multiply_add_gflop_per_s") * 1e9));
  return result;
}

}  // namespace

void bench_kernels(Device& device, const BenchOptions& options, BenchReport& report) {
  std::vector<KernelCase> chosen;
  for (KernelCase& tested : kernel_cases()) {
    if (("kernel/" + tested.method).find(options.filter) != std::string::npos) chosen.push_back(std::move(tested));
  }
  if (chosen.empty()) return;
  BenchFragments fragments(device, options.fragments);
  Roofline roofline(device, fragments.planes.padded_fragments);
  report.roofs["copy_gb_per_s"] = roofline.copy_bytes_per_s(options.repetitions) * 1e-9;
  report.roofs["multiply_add_gflop_per_s"] = roofline.multiply_adds_flop_per_s(options.repetitions) * 1e-9;
  for (const KernelCase& tested : chosen) {
    if (options.progress) options.progress("kernel/" + tested.method);
    report.results.push_back(measure(device, tested, fragments, roofline, options, report));
  }
}

}  // namespace understory
