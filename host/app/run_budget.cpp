#include "host/app/run_budget.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>

#include "bench/budget_check.hpp"
#include "host/app/checksum.hpp"
#include "host/app/interrupt.hpp"
#include "host/app/progress.hpp"
#include "host/app/run_identity.hpp"
#include "host/app/scene_world.hpp"

namespace understory {
namespace {

/// What times and errors depend on: program, scene, its files, device, threads.
std::string identity_of(const Scene& scene, const DeviceInfo& device, int threads) {
  const RunRecord run = describe_run(scene, {}, 1);
  std::string text =
      fmt::format("{} {} {} {} {} {} {} threads {}", run.program_sha256, run.scene_sha256, device.platform, device.name,
                  device.version, device.driver, device.compute_units, threads);
  for (const auto& [key, sha256] : run.inputs) text += " " + key + " " + sha256;
  return sha256_of_text(text);
}

std::string refusal_text(const BudgetOptions& asked, const TradeoffRow& nearest, const Promise& promise) {
  if (asked.max_error > 0)
    return fmt::format("--max-error {:g}: no methods keep it in this scene; the nearest, {}, promise {:.4f}",
                       asked.max_error, nearest.name, promise.rmse);
  return fmt::format(
      "--max-ms {:g}: no methods keep it in this scene; the fastest, {}, take up to {:.2f} ms, {:.2f} of them for "
      "posing and drawing",
      asked.max_ms, nearest.name, promise.ms, nearest.frame_ms - nearest.ms.median);
}

BudgetRecord record_of(const BudgetOptions& asked, const TradeoffTable& table, const CheckedChoice& checked) {
  BudgetRecord record;
  record.max_error = asked.max_error;
  record.max_ms = asked.max_ms;
  record.choice = table.rows[checked.choice.row].name;
  record.promised_rmse = checked.choice.promise.rmse;
  record.promised_ms = checked.choice.promise.ms;
  record.chosen_by = table.frames;
  record.checked_on = checked.frames;
  record.found_rmse = checked.found_rmse;
  return record;
}

}  // namespace

void add_budget_options(CLI::App& command, BudgetOptions& options) {
  CLI::Option* error =
      command
          .add_option("--max-error", options.max_error,
                      "Choose the fastest methods whose RMSE of V against traced truth stays below this in every frame")
          ->check(CLI::Range(1e-6, 1.0))
          ->type_name("E");
  CLI::Option* time =
      command
          .add_option(
              "--max-ms", options.max_ms,
              "Choose the most accurate methods that keep this device time of a frame, and adapt during the run")
          ->check(CLI::Range(1e-6, 1e6))
          ->type_name("T")
          ->excludes(error);
  for (const char* method : {"--tree", "--grass", "--crowns", "--occluders", "--near"})
    for (CLI::Option* budget : {error, time}) budget->excludes(command.get_option(method));
}

RunBudget choose_for_run(const BudgetOptions& budget, const DeviceOptions& on, const Scene& scene, bool quiet) {
  Device device(on.device);
  World world = read_world(scene, true);
  TradeoffOptions options = measuring_for_budget(identity_of(scene, device.info(), on.threads));
  Progress progress(1, 0, quiet);
  bool told = false;
  options.progress = [&](int total, const std::string& done) {
    if (!std::exchange(told, true) && !quiet)
      spdlog::info("measuring what each method of this scene costs and errs; kept for later runs");
    progress.advance(total, done);
  };
  options.stopped = [] { return interrupt_received() != 0; };
  TradeoffTable table = tradeoff_for_budget(device, world, options);
  progress.clear();
  RunBudget chosen;
  chosen.signal = interrupt_received();
  if (chosen.signal != 0) return chosen;

  ErrorsOnFrames errors(device, world, options);
  const int frames = scene.time.frames;
  const CheckedChoice checked = budget.max_error > 0 ? choose_within_error(table, frames, budget.max_error, errors)
                                                     : choose_within_time(table, frames, budget.max_ms, errors);
  chosen.kept = checked.choice.row != no_row;
  if (!chosen.kept) {
    chosen.refusal = refusal_text(budget, table.rows.at(checked.choice.nearest), checked.choice.promise);
    return chosen;
  }
  chosen.methods = table.rows[checked.choice.row].variant.methods;
  chosen.record = record_of(budget, table, checked);
  if (budget.max_error > 0) return chosen;
  for (const std::size_t row : steps_of_accuracy(table, frames))
    chosen.steps.push_back(
        {table.rows[row].name, table.rows[row].variant.methods, promise_of(table.rows[row], frames).ms});
  return chosen;
}

}  // namespace understory
