// Which methods keep an error or a time: a choice from a measured tradeoff, with what it promises of frames that nobody
// measured, and what is found there.
//
// The error of a frame is the RMSE of V against traced truth over judged pixels, the truth's own noise taken out, and
// of that the upper end of its 95 % interval.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "bench/tradeoff.hpp"

namespace understory {

/// What a row of a table lets expect of a frame that was not measured, by either camera.
struct Promise {
  double rmse = 1;  // no more than this, with 95 % confidence
  double ms = 0;    // device time of a whole frame: drawing and shading, upper ends of their intervals
};

/// The largest error among these views; those that see nothing do not count.
double worst_rmse(const std::vector<ViewError>& views);

/// The 95 % prediction bound for one frame more: mean over the measured frames, the worse camera's, and
/// t s sqrt(1 + 1/n), where s is the scatter of frames about their camera's mean, pooled over cameras, and t Student's
/// with as many degrees of freedom. No less than the worst frame that was measured. When all frames of the scene were
/// measured, or only one: the worst.
double promised_rmse(const std::vector<ViewError>& views, int frames_of_scene);
Promise promise_of(const TradeoffRow& row, int frames_of_scene);

/// The point below which Student's t lies with 95 % probability; `degrees` of freedom at least 1.
double student_t95(int degrees);

/// A row that a run may be made with: verified, at the scene's own size, without relaxed maths.
bool may_run(const TradeoffRow& row);

inline constexpr std::size_t no_row = static_cast<std::size_t>(-1);

struct BudgetChoice {
  std::size_t row = no_row;      // in TradeoffTable::rows; no_row: none keeps the budget
  std::size_t nearest = no_row;  // the row that comes nearest to keeping it: the one chosen, if any
  Promise promise;               // of `nearest`
};

/// The fastest row whose promise is within `max_rmse`. Throws Error(unexpected) for a table without a row to run.
BudgetChoice cheapest_within(const TradeoffTable& table, int frames_of_scene, double max_rmse);

/// Rows that kept `max_rmse` in every frame looked at though their promise is above it, and that are clearly faster
/// than `chosen` (no_row: than nothing); fastest first. More frames decide about them.
std::vector<std::size_t> doubtful_rows(const TradeoffTable& table, int frames_of_scene, double max_rmse,
                                       std::size_t chosen);

/// The row with the lowest promised error among those whose promised time is within `max_ms`.
BudgetChoice most_accurate_within(const TradeoffTable& table, int frames_of_scene, double max_ms);

/// The rows that are worth changing between while keeping a time: each slower than the one before, and with a lower
/// promised error.
std::vector<std::size_t> steps_of_accuracy(const TradeoffTable& table, int frames_of_scene);

/// Up to `count` frames of the scene that `used` does not hold, spread over them, ascending.
std::vector<int> unused_frames(int frames_of_scene, const std::vector<int>& used, int count);

}  // namespace understory
