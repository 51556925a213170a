// `run --max-error` and `run --max-ms`: which methods a run is made with, from the measured tradeoff of its scene.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "host/app/options.hpp"
#include "host/app/run_record.hpp"

namespace CLI {
class App;
}

namespace understory {

struct BudgetOptions {
  double max_error = 0;  // RMSE of V in a frame, as bench/budget.hpp defines it; 0: not asked for
  double max_ms = 0;     // device time of a frame; 0: not asked for
  bool given() const { return max_error > 0 || max_ms > 0; }
};

/// --max-error, --max-ms. After add_scene_options: whoever asks for a budget does not name methods.
void add_budget_options(CLI::App& command, BudgetOptions& options);

/// One choice of methods that an adaptive run may come to.
struct PaceStep {
  std::string name;
  Methods methods;
  double ms = 0;  // device time of a frame that is promised
};

struct RunBudget {
  bool kept = false;            // whether a choice keeps the budget; otherwise nothing is to be run
  std::string refusal;          // why not
  int signal = 0;               // that ended the measuring early; 0: none
  Methods methods;              // chosen
  BudgetRecord record;          // for run.json
  std::vector<PaceStep> steps;  // of --max-ms, from fast to accurate; empty: the run does not adapt
};

/// Chooses by the tradeoff of this scene on this device; measures it first, with progress, where it is not kept.
RunBudget choose_for_run(const BudgetOptions& budget, const DeviceOptions& device, const Scene& scene, bool quiet);

}  // namespace understory
