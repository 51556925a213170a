// Writes bench/budget.md: whether a choice by `run --max-error` keeps its promise on frames that it never saw, and how
// much faster the fastest method that would have kept it is. `budget_table [--minutes M] SCENE...`; standard output is
// the table. No scene is begun after M minutes; what was measured is kept, so that the next call gets further.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <limits>

#include "bench/budget_check.hpp"
#include "host/trace/calibrated_world.hpp"
#include "kernels/embedded.hpp"
#include "sim/error.hpp"
#include "sim/files/scene_file.hpp"

namespace understory {
namespace {

// RMSE of V, as a person would ask for them.
constexpr double budgets[] = {0.01, 0.015, 0.02, 0.03, 0.04, 0.05, 0.06, 0.08, 0.10, 0.12, 0.15, 0.20, 0.25, 0.30};
constexpr double tight = 0.9;    // a promise above this share of its budget is put to the test
constexpr int unseen_count = 4;  // frames, each by both cameras
constexpr int most_looks = 3;
constexpr int least_frames = 24;  // scenes with fewer go on for as many at their own rate

/// Upper ends of a row's errors in frames that nothing before has looked at, one a view.
class UnseenFrames {
 public:
  UnseenFrames(ErrorsOnFrames& errors, std::vector<int> frames) : errors_(errors), frames_(std::move(frames)) {}

  void look_at(const std::vector<const TradeoffRow*>& rows) { errors_.look_at(rows, frames_); }
  std::vector<double> of(const TradeoffRow& row) {
    std::vector<double> upper_ends;
    for (const ViewError& view : errors_.of(row, frames_))
      if (view.all.pixels > 0) upper_ends.push_back(view.all.high);
    return upper_ends;
  }

 private:
  ErrorsOnFrames& errors_;
  std::vector<int> frames_;
};

std::size_t count_within(const std::vector<double>& errors, double max_rmse) {
  return static_cast<std::size_t>(
      std::count_if(errors.begin(), errors.end(), [&](double error) { return error <= max_rmse; }));
}

/// What the program measures by changes with its kernels; measured tables are kept until one does.
std::string text_of_kernels() {
  std::string text;
  for (const std::string& program : embedded_programs()) text += expanded_source(program);
  return text;
}

struct Totals {
  std::size_t views = 0, kept = 0, tight_views = 0, tight_kept = 0, choices = 0, slow = 0, impossible = 0, missed = 0;
  double worst_ratio = 1;
};

/// The fastest row that kept the budget on the frames it was looked at when choosing and on the unseen ones: known only
/// afterwards.
const TradeoffRow* best_afterwards(const TradeoffTable& table, UnseenFrames& unseen, double max_rmse, double below_ms) {
  std::vector<const TradeoffRow*> candidates;
  for (const TradeoffRow& row : table.rows) {
    if (!may_run(row) || row.ms.median >= below_ms) continue;
    if (std::all_of(row.views.begin(), row.views.end(),
                    [&](const ViewError& view) { return view.all.high <= max_rmse; }))
      candidates.push_back(&row);
  }
  unseen.look_at(candidates);
  const TradeoffRow* best = nullptr;
  for (const TradeoffRow* row : candidates) {
    const std::vector<double> errors = unseen.of(*row);
    const bool keeps = count_within(errors, max_rmse) == errors.size();
    if (keeps && (!best || row->ms.median < best->ms.median)) best = row;
  }
  return best;
}

/// One line of the table: a budget of a scene, and what came of it.
void judge_budget(const std::string& scene, const TradeoffTable& measured, int frames, double budget,
                  ErrorsOnFrames& errors, UnseenFrames& unseen, Totals& totals) {
  TradeoffTable table = measured;
  const CheckedChoice checked = choose_within_error(table, frames, budget, errors);
  const auto text_of = [](const TradeoffRow& row) { return fmt::format("{:.3f} ({})", row.ms.median, row.name); };
  if (checked.choice.row == no_row) {
    const TradeoffRow* best = best_afterwards(table, unseen, budget, std::numeric_limits<double>::infinity());
    ++(best ? totals.missed : totals.impossible);
    fmt::print("| {} | {:g} | none | {:.4f} at best | | | | {} | |\n", scene, budget, checked.choice.promise.rmse,
               best ? text_of(*best) : "none");
    return;
  }
  const TradeoffRow& row = table.rows[checked.choice.row];
  const std::vector<double> found = unseen.of(row);
  const TradeoffRow* faster = best_afterwards(table, unseen, budget, row.ms.median);
  const double ratio = faster ? row.ms.median / faster->ms.median : 1;
  ++totals.choices;
  totals.slow += ratio > 1.2;
  totals.worst_ratio = std::max(totals.worst_ratio, ratio);
  totals.views += found.size();
  totals.kept += count_within(found, budget);
  if (checked.choice.promise.rmse > tight * budget) {
    totals.tight_views += found.size();
    totals.tight_kept += count_within(found, budget);
  }
  fmt::print("| {} | {:g} | {} | {:.4f} | {:.4f} | {} of {}, worst {:.4f} | {:.3f} | {} | {:.2f} |\n", scene, budget,
             row.name, checked.choice.promise.rmse, checked.found_rmse, count_within(found, budget), found.size(),
             found.empty() ? 0 : *std::max_element(found.begin(), found.end()), row.ms.median,
             faster ? text_of(*faster) : "the same", ratio);
  std::fflush(stdout);
}

void judge_scene(Device& device, const std::string& file, Totals& totals) {
  Scene scene = load_scene(file);
  const std::string name = std::filesystem::path(file).stem().string();
  scene.time.frames = std::max(scene.time.frames, least_frames);
  World world = build_world(scene);
  calibrate_world(world);
  TradeoffOptions options = measuring_for_budget(resolved_scene(scene) + device.info().name + text_of_kernels());
  options.progress = [&](int, const std::string& next) { fmt::print(stderr, "{}: {}\n", name, next); };
  const TradeoffTable measured = tradeoff_for_budget(device, world, options);
  const int frames = scene.time.frames;
  // Neither choosing nor checking, which may take several looks, gets to see the frames that are kept back.
  std::vector<int> used = measured.frames;
  for (int look = 0; look < most_looks; ++look)
    for (const int frame : unused_frames(frames, used, frames_to_check)) used.push_back(frame);
  ErrorsOnFrames errors(device, world, options);
  UnseenFrames unseen(errors, unused_frames(frames, used, unseen_count));
  for (const double budget : budgets) judge_budget(name, measured, frames, budget, errors, unseen, totals);
}

int write_table(const std::vector<std::string>& scenes, double minutes) {
  const auto started = std::chrono::steady_clock::now();
  Device device;
  fmt::print(
      "# Choices within an error\n\n"
      "Written by `build/release/bench/budget_table SCENES`; not edited by hand. On {}. Errors are upper ends of the\n"
      "95 % interval of the RMSE of V against traced truth, its noise taken out, per frame and camera; times are of "
      "the\n"
      "resolve and all visibility passes. Promised: from the frames by which was chosen. Checked: the worst of three\n"
      "other frames by both cameras. Unseen: {} frames by both cameras that nothing before has looked at. Best: the\n"
      "fastest row of the table that kept the budget in all frames looked at, which is known only afterwards.\n\n"
      "| scene | budget | choice | promised | checked | unseen within budget | ms | best, ms | ratio |\n"
      "|---|---|---|---|---|---|---|---|---|\n",
      device.info().name, unseen_count);
  Totals totals;
  std::vector<std::string> missing;
  for (const std::string& scene : scenes) {
    if (std::chrono::steady_clock::now() - started < std::chrono::duration<double>(60 * minutes))
      judge_scene(device, scene, totals);
    else
      missing.push_back(scene);
  }
  const auto share = [](std::size_t part, std::size_t all) { return all ? 100.0 * double(part) / double(all) : 0; };
  fmt::print(
      "\n{} of {} unseen scenes x budgets x frames x cameras within the budget ({:.1f} %; bar 95 %); of those where "
      "the\n"
      "promise is above {} of the budget {} of {} ({:.1f} %). {} of {} choices slower than 1.2 times the best, at "
      "most\n"
      "{:.2f} times. {} budgets that nothing in the table keeps were refused, and {} that something would have kept.\n",
      totals.kept, totals.views, share(totals.kept, totals.views), tight, totals.tight_kept, totals.tight_views,
      share(totals.tight_kept, totals.tight_views), totals.slow, totals.choices, totals.worst_ratio, totals.impossible,
      totals.missed);
  if (!missing.empty()) fmt::print("\nNot reached in {:g} minutes: {}.\n", minutes, fmt::join(missing, ", "));
  return 0;
}

}  // namespace
}  // namespace understory

int main(int argument_count, char** arguments) {
  try {
    std::vector<std::string> scenes(arguments + 1, arguments + argument_count);
    double minutes = std::numeric_limits<double>::infinity();
    if (scenes.size() >= 2 && scenes.front() == "--minutes") {
      minutes = std::stod(scenes[1]);
      scenes.erase(scenes.begin(), scenes.begin() + 2);
    }
    return understory::write_table(scenes, minutes);
  } catch (const std::exception& error) {
    fmt::print(stderr, "budget_table: {}\n", error.what());
    return 1;
  }
}
