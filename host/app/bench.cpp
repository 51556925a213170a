// `understory bench`: how fast kernels and frames are, beside what the device can do at most.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "bench/report.hpp"
#include "host/app/bench_builds.hpp"
#include "host/app/bench_errors.hpp"
#include "host/app/bench_json.hpp"
#include "host/app/bench_print.hpp"
#include "host/app/bench_roofline.hpp"
#include "host/app/bench_tune.hpp"
#include "host/app/commands.hpp"
#include "host/app/options.hpp"
#include "sim/error.hpp"

namespace understory {
namespace {

struct BenchCommand {
  BenchOptions bench;
  std::vector<std::string> devices;  // as --device; none: the one that every command takes
  int threads = 0;
  bool json = false, csv = false;
  bool builds = false;       // only build, and tell how long it took
  bool tune = false;         // measure and save how passes are launched best
  bool skip_builds = false;  // leave out cold and warm builds
  std::string roofline;      // PNG or SVG of the results under their roofs; empty: none
  std::string compare;       // file of an earlier report; empty: none
  std::string grids;         // Markdown file of the errors of moving bodies; empty: none
  std::string accuracy;      // Markdown file to write; empty: times are measured, not errors
  AccuracyOptions accuracy_options;
};

/// Selectors of the devices that were asked for.
std::vector<std::string> chosen_devices(const BenchCommand& command) {
  if (command.devices.empty()) return {""};
  if (command.devices != std::vector<std::string>{"all"}) return command.devices;
  std::vector<std::string> all;
  for (const DeviceInfo& device : list_devices()) all.push_back(std::to_string(device.index));
  return all.empty() ? std::vector<std::string>{""} : all;
}

bool has_kernels(const BenchReport& report) {
  return std::any_of(report.results.begin(), report.results.end(),
                     [](const BenchResult& result) { return result.name.starts_with("kernel/"); });
}

std::vector<BenchReport> measure(BenchCommand& command) {
  command.bench.progress = [](const std::string& name) { spdlog::info("{}", name); };
  std::vector<BenchReport> reports;
  for (const std::string& device : chosen_devices(command)) {
    command.bench.device = device;
    reports.push_back(run_bench(command.bench));
    if (!command.skip_builds && has_kernels(reports.back())) add_build_times(command.bench, reports.back());
  }
  return reports;
}

int bench(BenchCommand& command) {
  std::vector<BenchResult> then;
  if (!command.compare.empty()) then = read_bench_results(command.compare);
  if (!command.roofline.empty()) require_picture_name(command.roofline);
  const std::vector<BenchReport> reports = measure(command);
  if (!command.roofline.empty()) write_roofline(reports.front(), command.roofline);
  const std::vector<BenchChange> changes = compare_results(then, reports.front().results);
  if (command.json) {
    nlohmann::ordered_json json = bench_json(reports);
    if (!command.compare.empty()) json["changes"] = changes_json(changes);
    fmt::print("{}\n", json.dump(2));
  } else if (command.csv) {
    fmt::print("{}", bench_csv(reports));
  } else {
    for (const BenchReport& report : reports) fmt::print("{}\n", bench_text(report, command.bench.precision));
    if (reports.size() > 1) fmt::print("{}", side_by_side_text(reports));
    if (!command.compare.empty()) fmt::print("{}", changes_text(changes));
  }
  std::size_t wrong = 0, all = 0;
  for (const BenchReport& report : reports)
    for (const BenchResult& result : report.results) {
      ++all;
      if (!result.verified) ++wrong;
    }
  if (wrong > 0) spdlog::error("{} of {} results are wrong and were not timed", wrong, all);
  return wrong > 0 ? 1 : 0;
}

int run(BenchCommand& command) {
  DeviceOptions device;
  device.threads = command.threads;
  use_threads(device);
  const std::string first = chosen_devices(command).front();
  if (!command.grids.empty()) return bench_grid_errors(command.grids, first, command.bench.scenes);
  if (!command.accuracy.empty()) {
    command.accuracy_options.device = first;
    command.accuracy_options.filter = command.bench.filter;
    return bench_accuracy(command.accuracy, command.accuracy_options, command.json);
  }
  if (command.builds || command.tune) command.bench.device = first;
  if (command.tune) return bench_tune(command.bench);
  if (command.builds) return print_builds(command.bench);
  return bench(command);
}

void add_error_options(CLI::App& app, BenchCommand& command) {
  CLI::Option* accuracy = app.add_option("--accuracy", command.accuracy,
                                         "Measure errors against traced truth instead of times, into this Markdown "
                                         "file (-: only print); meshes from UNDERSTORY_DATA");
  app.add_option("--pictures", command.accuracy_options.pictures, "Folder for pictures truth | method | difference")
      ->needs(accuracy);
  app.add_option("--rays", command.accuracy_options.rays, "Rays per fragment of the truth")
      ->check(CLI::Range(16, 1 << 24))
      ->needs(accuracy)
      ->capture_default_str();
  app.add_option("--per-side", command.accuracy_options.fragments, "Fragments judged per side and surface")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 20))
      ->needs(accuracy)
      ->capture_default_str();
  app.add_option("--grids", command.grids,
                 "Measure how far moving bodies of the SCENEs are from traced truth, by every method and rule of "
                 "combining, into this Markdown file (-: only print)");
}

void add_options(CLI::App& app, BenchCommand& command) {
  BenchOptions& options = command.bench;
  app.add_option("SCENE", options.scenes, "Scenes whose frames are timed; without one, kernels only")
      ->check(CLI::ExistingFile);
  app.add_option("--filter", options.filter,
                 "Only results whose name contains this (kernel/sphere-cap, frame/; of errors, birch/dome/)");
  app.add_option("--fragments", options.fragments, "Sizes of the kernel benchmarks")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 28))
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--precision", options.precision, "Half an interval over its median at which repeating a kernel ends")
      ->check(CLI::Range(1e-4, 1.0))
      ->capture_default_str();
  app.add_option("--repetitions", options.repetitions, "Timed runs of each kernel, instead of a precision")
      ->check(CLI::Range(1, 10000));
  app.add_option("--frames", options.frames, "Timed frames of each scene, after a cold one")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  CLI::Option* json = app.add_flag("--json", command.json, "Print one JSON object");
  app.add_flag("--csv", command.csv, "Print comma-separated values")->excludes(json);
  app.add_option("--compare", command.compare, "Report of an earlier --json to set beside this one");
  app.add_option("--roofline", command.roofline,
                 "Draw the kernels under their roofs into this PNG or SVG, of several devices the first")
      ->type_name("FILE");
  app.add_flag("--builds", command.builds, "Only build and run each kernel once, and tell how long it took");
  app.add_flag(
      "--tune", command.tune,
      "Measure how each pass is launched best on this device (work-group and fragments per work-item) and save "
      "it for all commands; results stay the same");
  app.add_flag("--skip-builds", command.skip_builds, "Leave out how long kernels take to build, cold and warm");
  add_error_options(app, command);
  app.add_option("--device", command.devices,
                 "Index, cpu, gpu, or part of a name; see `understory devices`. Several, or all: side by side")
      ->envname("UNDERSTORY_DEVICE")
      ->allow_extra_args(false);
  app.add_option("--threads", command.threads, "Processor threads to use; results do not depend on it")
      ->check(CLI::Range(1, 4096));
}

}  // namespace

void add_bench(CLI::App& program, Command& chosen) {
  CLI::App* app = program.add_subcommand("bench", "Time kernels and frames beside what the device can do at most");
  const auto command = std::make_shared<BenchCommand>();
  add_options(*app, *command);
  app->footer(
      "median: by the device's clock, with the interval that holds it with 95 % confidence; ~: wider than asked for.\n"
      "roof: share of the nearest of the ceilings that this run measured, memory beside a kernel that only moves as\n"
      "many planes. Results are verified first: a wrong one is named, not timed, and makes the exit code 1.");
  app->callback([command, &chosen] { chosen = [command] { return run(*command); }; });
}

}  // namespace understory
