// How long each kernel takes from its source to the end of its first run, on few fragments.
#include <chrono>
#include <numeric>

#include "bench/kernel_cases.hpp"
#include "bench/report.hpp"
#include "bench/timing.hpp"
#include "sim/error.hpp"

namespace understory {
namespace {

constexpr std::size_t few_fragments = 1 << 11;

double built_so_far(const Device& device) {
  const std::map<std::string, double> times = device.build_times();
  return std::accumulate(times.begin(), times.end(), 0.0,
                         [](double sum, const auto& program) { return sum + program.second; });
}

}  // namespace

void time_builds(const BenchOptions& options,
                 const std::function<void(const std::string& name, const BuildTimes* times)>& told) {
  bool any = false;
  for (const KernelCase& tested : kernel_cases()) {
    const std::string name = "kernel/" + tested.kernel;
    const std::string sizes = name + "/";  // a filter may name a size of the kernel, which is built but once
    if (sizes.find(options.filter) == std::string::npos && options.filter.find(sizes) == std::string::npos) continue;
    any = true;
    if (options.progress) options.progress(name);
    Device device(options.device);  // of its own: nothing is built yet
    BenchFragments fragments(device, few_fragments);
    const ReadyKernel ready = tested.prepare(device, fragments);
    device.finish();
    told(name, nullptr);
    BuildTimes times;
    times.build_ms = built_so_far(device);
    times.first_launch_ms = wall_milliseconds(device, ready.run);
    times.items = ready.items;
    told(name, &times);
  }
  if (!any) throw Error(ErrorKind::usage, "--filter " + options.filter + ": no kernel has this in its name");
}

}  // namespace understory
