#include "bench/tune.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>

#include "bench/kernel_cases.hpp"
#include "bench/timing.hpp"
#include "sim/error.hpp"

namespace understory {
namespace {

constexpr StopRule glance{5, 5, 0, 0, true};
constexpr StopRule judgement{15, 60, 0.01, 1.0, true};

std::vector<LaunchShape> candidates() {
  std::vector<LaunchShape> shapes;
  for (const int lanes : {1, 4, 8, 16})
    for (const int group : {64, 256, 1024, 4096}) shapes.push_back({lanes, group});
  return shapes;
}

/// The kernel as it runs in this shape; null when its result is wrong then, which no shape may cause.
ReadyKernel ready_in(Device& device, BenchFragments& fragments, const KernelCase& tested, LaunchShape shape) {
  device.tune(tested.kernel, shape);
  ReadyKernel ready = tested.prepare(device, fragments);
  ready.run();
  if (const double error = ready.error(); !(error <= tested.tolerance))
    throw Error(ErrorKind::unexpected,
                fmt::format("kernel/{} is wrong by {} with {} fragments per work-item and {} per "
                            "group",
                            tested.kernel, error, shape.lanes, shape.group));
  return ready;
}

TunedPass tune_pass(Device& device, BenchFragments& fragments, const KernelCase& tested) {
  const ReadyKernel built_in = ready_in(device, fragments, tested, {});
  LaunchShape best;
  double least = std::numeric_limits<double>::infinity();
  for (const LaunchShape& shape : candidates()) {
    const ReadyKernel ready = ready_in(device, fragments, tested, shape);
    const double ms = time_in_turn(device, {ready.run}, glance).front().device_ms.median;
    if (ms >= least) continue;
    least = ms;
    best = shape;
  }
  const ReadyKernel ready = ready_in(device, fragments, tested, best);
  const std::vector<MeasuredTime> times = time_in_turn(device, {built_in.run, ready.run}, judgement);
  const Spread95 before = times[0].device_ms, after = times[1].device_ms;
  return {tested.kernel, after.high < before.low ? best : LaunchShape{}, after.median, before.median};
}

}  // namespace

std::vector<TunedPass> tune_passes(const BenchOptions& options) {
  Device device(options.device);
  BenchFragments fragments(device, options.fragments.front());
  // Their launch shapes follow from the geometry, or from tiles alone.
  const std::set<std::string> fixed = {"pose-mesh",          "pose-grass",      "draw-blades", "draw-far",
                                       "rasterise-mesh",     "rasterise-grass", "resolve",     "depth-moments",
                                       "normals-from-depth", "obscurance-half"};
  std::vector<TunedPass> passes;
  for (const KernelCase& tested : kernel_cases()) {
    const std::string name = "kernel/" + tested.kernel;
    const bool variant = tested.kernel.find('/') != std::string::npos;
    if (variant || fixed.contains(tested.kernel) || name.find(options.filter) == std::string::npos) continue;
    if (options.progress) options.progress("tuning " + name);
    passes.push_back(tune_pass(device, fragments, tested));
  }
  if (passes.empty())
    throw Error(ErrorKind::usage, "--filter " + options.filter + ": no pass that can be tuned has this in its name");
  return passes;
}

std::string tuning_text(const DeviceInfo& device, const std::vector<TunedPass>& passes, const TuningTable& kept) {
  std::string text = fmt::format(
      "# How passes are launched on {} ({}, {}).\n# Written by `understory bench --tune`; results do not depend on it. "
      "Without this file the built-in shapes are used.\n# {:22}{:>12}{:>12}   per work-item and per group, fragments\n",
      device.name, device.platform, device.driver, "pass", "lanes", "group");
  std::set<std::string> measured;
  for (const TunedPass& row : passes) {
    measured.insert(row.pass);
    if (row.shape == LaunchShape{}) continue;
    text += fmt::format("{:24}{:>12}{:>12}   # {:.3f} ms, built-in {:.3f} ms\n", row.pass, row.shape.lanes,
                        row.shape.group, row.ms, row.built_in_ms);
  }
  for (const auto& [pass, shape] : kept)
    if (!measured.contains(pass)) text += fmt::format("{:24}{:>12}{:>12}\n", pass, shape.lanes, shape.group);
  return text;
}

}  // namespace understory
