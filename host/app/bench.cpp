// `understory bench`: how fast kernels and frames are, beside what the device can do at most.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>

#include "bench/accuracy.hpp"
#include "bench/grid_accuracy.hpp"
#include "bench/report.hpp"
#include "host/app/bench_json.hpp"
#include "host/app/commands.hpp"
#include "host/app/options.hpp"
#include "sim/error.hpp"
#include "sim/files/atomic_file.hpp"

namespace understory {
namespace {

struct BenchCommand {
  BenchOptions bench;
  DeviceOptions device;
  bool json = false;
  std::string compare;   // file of an earlier report; empty: none
  std::string grids;     // Markdown file of the errors of moving bodies; empty: none
  std::string accuracy;  // Markdown file to write; empty: times are measured, not errors
  AccuracyOptions accuracy_options;
};

/// "12.3 M", for rates.
std::string rate_text(double per_second) {
  if (per_second >= 1e9) return fmt::format("{:.2f} G", per_second * 1e-9);
  if (per_second >= 1e6) return fmt::format("{:.1f} M", per_second * 1e-6);
  return fmt::format("{:.1f}  ", per_second);
}

/// A column that may be unknown.
std::string known(double value, const char* unit, int digits) {
  return value > 0 ? fmt::format("{:.{}f}{}", value, digits, unit) : "";
}

void print_result(const BenchResult& result) {
  if (!result.verified) {
    fmt::print("{:38} WRONG: deviates by {:.3g}\n", result.name, result.max_error);
    return;
  }
  fmt::print("{:38}{:9.3f}{:9.3f}{:9.3f}{:>10}{:>11}/s{:>8}{:>7}{:>7} {}\n", result.name, result.median_ms,
             result.low_ms, result.high_ms, known(result.cold_ms, "", 1), rate_text(result.items_per_s),
             known(result.bytes_per_s * 1e-9, "", 1), known(result.plane_share, "", 2), known(result.roof_share, "", 2),
             result.bound_by);
}

void print_report(const BenchReport& report) {
  fmt::print("{} ({}), {} compute units\n", report.device.name, report.device.platform, report.device.compute_units);
  for (const auto& [roof, value] : report.roofs) fmt::print("  {:28}{:9.1f}\n", roof, value);
  fmt::print("{:38}{:>9}{:>9}{:>9}{:>10}{:>13}{:>8}{:>7}{:>7} {}\n", "", "median ms", "low", "high", "cold ms", "items",
             "GB/s", "planes", "roof", "bound by");
  for (const BenchResult& result : report.results) print_result(result);
}

void print_changes(const std::vector<BenchChange>& changes) {
  fmt::print("\n{:38}{:>9}{:>9}{:>8}\n", "", "then ms", "now ms", "ratio");
  for (const BenchChange& change : changes) {
    const char* verdict = !change.changed ? "" : change.ratio > 1 ? "slower" : "faster";
    fmt::print("{:38}{:9.3f}{:9.3f}{:8.2f} {}\n", change.name, change.old_ms, change.new_ms, change.ratio, verdict);
  }
}

int bench(BenchCommand& command) {
  use_threads(command.device);
  command.bench.device = command.device.device;
  command.bench.progress = [](const std::string& name) { spdlog::info("{}", name); };
  std::vector<BenchResult> then;
  if (!command.compare.empty()) then = read_bench_results(command.compare);
  const BenchReport report = run_bench(command.bench);
  nlohmann::ordered_json json = bench_json(report);
  const std::vector<BenchChange> changes = compare_results(then, report.results);
  if (!command.compare.empty()) {
    json["changes"] = nlohmann::ordered_json::array();
    for (const BenchChange& change : changes)
      json["changes"].push_back({{"name", change.name},
                                 {"old_ms", change.old_ms},
                                 {"new_ms", change.new_ms},
                                 {"ratio", change.ratio},
                                 {"changed", change.changed}});
  }
  if (command.json) {
    fmt::print("{}\n", json.dump(2));
  } else {
    print_report(report);
    if (!command.compare.empty()) print_changes(changes);
  }
  const auto wrong = std::count_if(report.results.begin(), report.results.end(),
                                   [](const BenchResult& result) { return !result.verified; });
  if (wrong > 0) spdlog::error("{} of {} results are wrong and were not timed", wrong, report.results.size());
  return wrong > 0 ? 1 : 0;
}

void print_accuracy(const AccuracyReport& report) {
  fmt::print("{:28}{:8}{:8}{:36}{:>8}{:>9}{:>9}{:>9}{:>9}{:>9}\n", "scene", "setting", "surface", "method", "pixels",
             "RMSE", "bias", "log", "noise", "constant");
  for (const AccuracyRow& row : report.rows)
    fmt::print("{:28}{:8}{:8}{:36}{:>8}{:>9.4f}{:>9.4f}{:>9.3f}{:>9.4f}{:>9.4f}\n", row.scene, row.setting, row.surface,
               row.method, row.errors.pixels, row.errors.rmse, row.errors.bias, row.errors.log_mae,
               row.errors.truth_noise, row.errors.best_constant);
  for (const TruthRow& row : report.truth) {
    fmt::print("{:28}{:8}truth: {:.2f} million rays/s, intervals hold {:.3f} of {}; by tenth", row.scene, row.setting,
               row.rays_per_s * 1e-6, row.inside, row.fragments);
    for (int tenth = 0; tenth < 10; ++tenth) fmt::print(" {:.3f}", row.tenth_inside[tenth]);
    fmt::print("\n");
  }
  for (const CanopyTruth& canopy : report.canopies)
    fmt::print("canopy LAI {:<3} {:.5f} +- {:.5f}, closed form {:.5f}\n", canopy.leaf_area_index, canopy.traced,
               canopy.standard_error, canopy.closed_form);
}

/// Errors of the methods of moving bodies instead of times.
int bench_grid_errors(const BenchCommand& command) {
  use_threads(command.device);
  GridAccuracyOptions options;
  options.device = command.device.device;
  options.scenes = command.bench.scenes;
  options.progress = [](const std::string& name) { spdlog::info("{}", name); };
  if (options.scenes.empty()) throw Error(ErrorKind::usage, "--grids needs scenes with occluders");
  const std::string table = grid_accuracy_markdown(measure_grid_accuracy(options));
  if (command.grids == "-")
    fmt::print("{}", table);
  else
    write_file_atomically(command.grids, table);
  return 0;
}

/// Errors instead of times.
int bench_accuracy(BenchCommand& command) {
  use_threads(command.device);
  AccuracyOptions& options = command.accuracy_options;
  options.device = command.device.device;
  options.filter = command.bench.filter;
  options.progress = [](const std::string& name) { spdlog::info("{}", name); };
  const char* data = std::getenv("UNDERSTORY_DATA");
  if (!data || !*data) throw Error(ErrorKind::usage, "--accuracy needs the data folder: set UNDERSTORY_DATA to it");
  options.data = data;
  const AccuracyReport report = measure_accuracy(options);
  if (command.accuracy != "-") write_file_atomically(command.accuracy, accuracy_markdown(report));
  if (command.json)
    fmt::print("{}\n", accuracy_json(report).dump(2));
  else
    print_accuracy(report);
  for (const std::string& name : report.unknown) spdlog::warn("there is no method '{}' in this build", name);
  return 0;
}

}  // namespace

void add_bench(CLI::App& program, Command& chosen) {
  CLI::App* app = program.add_subcommand("bench", "Time kernels and frames beside what the device can do at most");
  const auto command = std::make_shared<BenchCommand>();
  BenchOptions& options = command->bench;
  app->add_option("SCENE", options.scenes, "Scenes whose frames are timed; without one, kernels only")
      ->check(CLI::ExistingFile);
  app->add_option("--filter", options.filter,
                  "Only results whose name contains this (kernel/sphere-cap, frame/; of errors, birch/dome/)");
  app->add_option("--fragments", options.fragments, "Fragments of the kernel benchmarks")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 28))
      ->capture_default_str();
  app->add_option("--repetitions", options.repetitions, "Timed runs of each kernel")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  app->add_option("--frames", options.frames, "Timed frames of each scene, after a cold one")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  app->add_flag("--json", command->json, "Print one JSON object");
  app->add_option("--compare", command->compare, "Report of an earlier --json to set beside this one");
  CLI::Option* accuracy = app->add_option("--accuracy", command->accuracy,
                                          "Measure errors against traced truth instead of times, into this Markdown "
                                          "file (-: only print); meshes from UNDERSTORY_DATA");
  app->add_option("--pictures", command->accuracy_options.pictures, "Folder for pictures truth | method | difference")
      ->needs(accuracy);
  app->add_option("--rays", command->accuracy_options.rays, "Rays per fragment of the truth")
      ->check(CLI::Range(16, 1 << 24))
      ->needs(accuracy)
      ->capture_default_str();
  app->add_option("--per-side", command->accuracy_options.fragments, "Fragments judged per side and surface")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 20))
      ->needs(accuracy)
      ->capture_default_str();
  app->add_option("--grids", command->grids,
                  "Measure how far moving bodies of the SCENEs are from traced truth, by every method and rule of "
                  "combining, into this Markdown file (-: only print)");
  add_device_options(*app, command->device);
  app->footer(
      "low and high enclose the median with 95 % confidence. cold: first run, compiling included. planes: speed over\n"
      "that of a kernel that only reads as many planes and writes one; roof: over the nearest ceiling. Results are\n"
      "verified first: a wrong one is named, not timed, and makes the exit code 1.");
  app->callback([command, &chosen] {
    chosen = [command] {
      if (!command->grids.empty()) return bench_grid_errors(*command);
      return command->accuracy.empty() ? bench(*command) : bench_accuracy(*command);
    };
  });
}

}  // namespace understory
