// One cold frame, then warm ones, each at its own time; the last is drawn twice and must be the same.
#include "bench/frame.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "bench/timing.hpp"
#include "host/frame/runner.hpp"
#include "sim/files/scene_file.hpp"
#include "sim/world.hpp"

namespace understory {
namespace {

/// Samples of the warm frames: wall, per pass, of all visibility passes, and fragments that are not background.
struct FrameSamples {
  std::vector<double> wall_ms, visibility_ms, covered;
  std::map<std::string, std::vector<double>> pass_ms;
};

/// V of every fragment is a number within [0, 1].
bool is_sound(const Frame& frame) {
  return frame.visibility.size() == frame.pixels() &&
         std::all_of(frame.visibility.begin(), frame.visibility.end(), [](float v) { return v >= 0 && v <= 1; });
}

bool is_same(const Frame& a, const Frame& b) {
  return a.depth == b.depth && a.owner == b.owner && a.visibility == b.visibility;
}

/// Milliseconds of the passes that follow the resolve.
double visibility_milliseconds(const Plan& plan, const Frame& frame) {
  double sum = 0;
  bool resolved = false;
  for (const PlannedPass& pass : plan.passes) {
    const auto found = frame.pass_ms.find(pass.name);
    if (resolved && found != frame.pass_ms.end()) sum += found->second;
    resolved = resolved || pass.name == "resolve";
  }
  return sum;
}

void add_sample(const FrameRunner& runner, const Frame& frame, double wall_ms, FrameSamples& samples) {
  samples.wall_ms.push_back(wall_ms);
  samples.visibility_ms.push_back(visibility_milliseconds(runner.plan(), frame));
  samples.covered.push_back(static_cast<double>(
      std::count_if(frame.owner.begin(), frame.owner.end(), [](auto owner) { return owner != 0; })));
  for (const auto& [pass, milliseconds] : frame.pass_ms) samples.pass_ms[pass].push_back(milliseconds);
}

/// A result of `items` per sample. Nothing is timed unless it is right.
BenchResult result_of(const std::string& name, const std::vector<double>& samples, double items, bool verified) {
  BenchResult result;
  result.name = name;
  result.verified = verified;
  if (!verified) return result;
  const Spread95 spread = spread_of(samples);
  result.median_ms = spread.median;
  result.low_ms = spread.low;
  result.high_ms = spread.high;
  if (spread.median > 0) result.items_per_s = items / (spread.median * 1e-3);
  return result;
}

void bench_scene(Device& device, const std::filesystem::path& file, const BenchOptions& options, BenchReport& report) {
  const Scene scene = load_scene(file);
  const std::string name = "frame/" + file.stem().string();
  if (options.progress) options.progress(name);
  const World world = build_world(scene);
  std::optional<FrameRunner> runner;
  Frame last;
  const auto render = [&](int index) { runner->render(last, index, scene.time.at(index)); };

  const double cold_ms = wall_milliseconds(device, [&] {
    runner.emplace(device, world);
    render(0);
  });
  FrameSamples samples;
  for (int index = 1; index <= options.frames; ++index) {
    const double wall_ms = wall_milliseconds(device, [&] { render(index); });
    add_sample(*runner, last, wall_ms, samples);
  }
  const Frame before = last;
  render(options.frames);
  const bool verified = is_sound(last) && is_same(last, before);

  BenchResult whole = result_of(name, samples.wall_ms, 1, verified);
  whole.wall_ms = whole.median_ms;
  whole.cold_ms = cold_ms;
  report.results.push_back(whole);
  const double covered = spread_of(samples.covered).median;
  report.results.push_back(result_of(name + "/visibility", samples.visibility_ms, covered, verified));
  for (const auto& [pass, milliseconds] : samples.pass_ms) {
    report.results.push_back(result_of(name + "/" + pass, milliseconds, 1, verified));
  }
}

}  // namespace

void bench_frames(Device& device, const BenchOptions& options, BenchReport& report) {
  for (const std::filesystem::path& file : options.scenes) {
    if (("frame/" + file.stem().string()).find(options.filter) != std::string::npos) {
      bench_scene(device, file, options, report);
    }
  }
}

}  // namespace understory
