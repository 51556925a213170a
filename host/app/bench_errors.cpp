#include "host/app/bench_errors.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "bench/grid_accuracy.hpp"
#include "host/app/bench_json.hpp"
#include "sim/error.hpp"
#include "sim/files/atomic_file.hpp"

namespace understory {
namespace {

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

}  // namespace

int bench_grid_errors(const std::string& table, const std::string& device,
                      const std::vector<std::filesystem::path>& scenes) {
  GridAccuracyOptions options;
  options.device = device;
  options.scenes = scenes;
  options.progress = [](const std::string& name) { spdlog::info("{}", name); };
  if (options.scenes.empty()) throw Error(ErrorKind::usage, "--grids needs scenes with occluders");
  const std::string text = grid_accuracy_markdown(measure_grid_accuracy(options));
  if (table == "-")
    fmt::print("{}", text);
  else
    write_file_atomically(table, text);
  return 0;
}

int bench_accuracy(const std::string& table, AccuracyOptions options, bool json) {
  options.progress = [](const std::string& name) { spdlog::info("{}", name); };
  const char* data = std::getenv("UNDERSTORY_DATA");
  if (!data || !*data) throw Error(ErrorKind::usage, "--accuracy needs the data folder: set UNDERSTORY_DATA to it");
  options.data = data;
  const AccuracyReport report = measure_accuracy(options);
  if (table != "-") write_file_atomically(table, accuracy_markdown(report));
  if (json)
    fmt::print("{}\n", accuracy_json(report).dump(2));
  else
    print_accuracy(report);
  for (const std::string& name : report.unknown) spdlog::warn("there is no method '{}' in this build", name);
  return 0;
}

}  // namespace understory
