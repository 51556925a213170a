// From a scene to a choice that keeps its budget: the tradeoff that is measured once and kept, the choice by it, and
// whether the choice keeps its promise on frames that it was not made by.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/budget.hpp"

namespace understory {

class TradeoffJudge;

/// Frames by which methods are chosen, and others on which a choice is checked; each by both cameras.
inline constexpr int frames_to_choose_by = 4, frames_to_check = 3;

/// How much is measured before a run: less than by `understory tradeoff`, and only what a run may be made with.
TradeoffOptions measuring_for_budget(const std::string& identity);

/// The tradeoff by which a run of this world chooses: kept between runs by options.identity
/// (host/trace/bake_cache.hpp), measured when it is not there. `world` is calibrated. Nothing is kept of one that
/// options.stopped ended.
TradeoffTable tradeoff_for_budget(Device& device, World& world, TradeoffOptions options);

/// What rows err on frames of the scene, by both cameras, as TradeoffRow::views. Whatever was found once is kept.
class ErrorsOnFrames {
 public:
  /// Device and world must outlive it; the world's camera moves from the first look until it goes. Pixels and rays are
  /// those of `options`.
  ErrorsOnFrames(Device& device, World& world, const TradeoffOptions& options);
  ~ErrorsOnFrames();
  /// Looks at several rows together. Frames are traced once, plants uploaded once.
  void look_at(const std::vector<const TradeoffRow*>& rows, const std::vector<int>& frames);
  const std::vector<ViewError>& of(const TradeoffRow& row, const std::vector<int>& frames);

 private:
  Device& device_;
  World& world_;
  TradeoffOptions options_;
  std::unique_ptr<TradeoffJudge> judge_;                                              // from the first look on
  std::map<std::pair<std::vector<int>, std::string>, std::vector<ViewError>> found_;  // by frames and name of the row
};

/// A choice, and what was found on frames that it was not made by.
struct CheckedChoice {
  BudgetChoice choice;
  std::vector<int> frames;  // looked at; empty: the scene has no more
  double found_rmse = 0;    // upper end of the error in the worst of these frames
};

/// cheapest_within, and a look at other frames. Where that finds more than `max_rmse`, what was found joins what the
/// row is judged by (in `table`), and the choice is made again. Likewise for faster rows that kept the error so far but
/// promise too little to be chosen (doubtful_rows): they are looked at further before anything is chosen. A choice
/// without a row: none keeps the error.
CheckedChoice choose_within_error(TradeoffTable& table, int frames_of_scene, double max_rmse, ErrorsOnFrames& errors);

/// most_accurate_within, and what its error is on other frames.
CheckedChoice choose_within_time(TradeoffTable& table, int frames_of_scene, double max_ms, ErrorsOnFrames& errors);

}  // namespace understory
