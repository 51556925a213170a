// All benchmarks in one run.
#include "bench/frame.hpp"
#include "bench/grid_features.hpp"
#include "bench/grids.hpp"
#include "bench/kernels.hpp"
#include "bench/peers.hpp"
#include "bench/report.hpp"
#include "sim/error.hpp"

namespace understory {

BenchReport run_bench(const BenchOptions& options) {
  Device device(options.device);
  BenchReport report;
  report.device = device.info();
  bench_kernels(device, options, report);
  bench_peers(device, options, report);
  bench_frames(device, options, report);
  if (options.filter.find("grid/") != std::string::npos) {  // minutes: only when asked for
    bench_grids(device, options, report);
    bench_grid_features(device, options, report);
  }
  if (report.results.empty())
    throw Error(ErrorKind::usage, "--filter " + options.filter +
                                      ": no benchmark has this in its name; names are kernel/..., peer/..., truth/..., "
                                      "bake/..., grid/... and, of the scenes given, frame/SCENE, as `understory bench` "
                                      "lists them");
  return report;
}

}  // namespace understory
