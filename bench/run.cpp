// All benchmarks in one run, and what changed between two.
#include <algorithm>

#include "bench/frame.hpp"
#include "bench/grid_features.hpp"
#include "bench/grids.hpp"
#include "bench/kernels.hpp"
#include "bench/report.hpp"
#include "sim/error.hpp"

namespace understory {

BenchReport run_bench(const BenchOptions& options) {
  Device device(options.device);
  BenchReport report;
  report.device = device.info();
  bench_kernels(device, options, report);
  bench_frames(device, options, report);
  bench_grids(device, options, report);
  bench_grid_features(device, options, report);
  if (report.results.empty())
    throw Error(ErrorKind::usage, "--filter " + options.filter +
                                      ": no benchmark has this in its name; names are kernel/METHOD and, of the "
                                      "scenes given, frame/SCENE, as `understory bench` lists them");
  return report;
}

std::vector<BenchChange> compare_results(const std::vector<BenchResult>& then, const std::vector<BenchResult>& now) {
  std::vector<BenchChange> changes;
  for (const BenchResult& result : now) {
    const auto old =
        std::find_if(then.begin(), then.end(), [&](const BenchResult& r) { return r.name == result.name; });
    if (old == then.end() || !old->verified || !result.verified) continue;
    const bool apart = result.low_ms > old->high_ms || result.high_ms < old->low_ms;
    changes.push_back({result.name, old->median_ms, result.median_ms, result.median_ms / old->median_ms, apart});
  }
  return changes;
}

}  // namespace understory
