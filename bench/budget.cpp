#include "bench/budget.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "sim/error.hpp"

namespace understory {
namespace {

constexpr double faster_enough = 0.95;    // of the other's time: less of a gain is not worth a look
constexpr double z = 1.6448536269514722;  // 95 % of a normal distribution lie below

/// Best first by `less`, of the rows that may be run.
template <typename Less>
std::vector<std::size_t> rows_in_order(const TradeoffTable& table, const Less& less) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    if (may_run(table.rows[i])) rows.push_back(i);
  if (rows.empty()) throw Error(ErrorKind::unexpected, "the tradeoff of " + table.scene + " holds no method to run");
  std::stable_sort(rows.begin(), rows.end(), less);
  return rows;
}

std::vector<std::size_t> rows_by_time(const TradeoffTable& table) {
  return rows_in_order(table,
                       [&](std::size_t a, std::size_t b) { return table.rows[a].ms.median < table.rows[b].ms.median; });
}

double draw_ms(const TradeoffRow& row) { return row.frame_ms - row.ms.median; }

std::vector<Promise> promises_of(const TradeoffTable& table, int frames_of_scene) {
  std::vector<Promise> promises;
  for (const TradeoffRow& row : table.rows) promises.push_back(promise_of(row, frames_of_scene));
  return promises;
}

}  // namespace

double student_t95(int degrees) {
  if (degrees <= 1) return std::tan(0.45 * M_PI);
  if (degrees == 2) return 0.9 * std::sqrt(2 / (1 - 0.81));
  // Abramowitz and Stegun, Handbook of Mathematical Functions, 26.7.5; right to 5e-4 from 3 degrees on.
  const double z2 = z * z, n = degrees;
  const double g1 = (z2 + 1) * z / 4;
  const double g2 = ((5 * z2 + 16) * z2 + 3) * z / 96;
  const double g3 = (((3 * z2 + 19) * z2 + 17) * z2 - 15) * z / 384;
  const double g4 = ((((79 * z2 + 776) * z2 + 1482) * z2 - 1920) * z2 - 945) * z / 92160;
  return z + g1 / n + g2 / (n * n) + g3 / (n * n * n) + g4 / (n * n * n * n);
}

double worst_rmse(const std::vector<ViewError>& views) {
  double worst = 0;
  for (const ViewError& view : views)
    if (view.all.pixels > 0) worst = std::max(worst, view.all.high);
  return worst;
}

double promised_rmse(const std::vector<ViewError>& views, int frames_of_scene) {
  std::map<int, std::vector<double>> by_camera;
  std::set<int> frames;
  const double worst = worst_rmse(views);
  for (const ViewError& view : views) {
    if (view.all.pixels == 0) continue;  // nothing is seen there
    by_camera[view.camera].push_back(view.all.high);
    frames.insert(view.frame);
  }
  double squares = 0, highest = 0;
  int degrees = 0;
  for (const auto& [camera, errors] : by_camera) {
    double mean = 0;
    for (const double error : errors) mean += error / static_cast<double>(errors.size());
    for (const double error : errors) squares += (error - mean) * (error - mean);
    degrees += static_cast<int>(errors.size()) - 1;
  }
  const bool nothing_unseen = static_cast<int>(frames.size()) >= frames_of_scene;
  if (degrees == 0 || nothing_unseen) return worst;
  const double reach = student_t95(degrees) * std::sqrt(squares / degrees);
  for (const auto& [camera, errors] : by_camera) {
    const auto count = static_cast<double>(errors.size());
    double sum = 0;
    for (const double error : errors) sum += error;
    highest = std::max(highest, sum / count + reach * std::sqrt(1 + 1 / count));
  }
  return std::min(1.0, std::max(worst, highest));
}

Promise promise_of(const TradeoffRow& row, int frames_of_scene) {
  return {promised_rmse(row.views, frames_of_scene), row.ms.high + draw_ms(row)};
}

bool may_run(const TradeoffRow& row) {
  return row.verified && row.variant.shrink == 1 && !row.variant.relaxed_maths && !row.views.empty();
}

BudgetChoice cheapest_within(const TradeoffTable& table, int frames_of_scene, double max_rmse) {
  const std::vector<Promise> promises = promises_of(table, frames_of_scene);
  BudgetChoice choice;
  for (const std::size_t row : rows_by_time(table)) {
    if (choice.nearest == no_row || promises[row].rmse < promises[choice.nearest].rmse) choice.nearest = row;
    if (promises[row].rmse > max_rmse) continue;
    choice.row = choice.nearest = row;
    break;
  }
  choice.promise = promises[choice.nearest];
  return choice;
}

std::vector<std::size_t> doubtful_rows(const TradeoffTable& table, int frames_of_scene, double max_rmse,
                                       std::size_t chosen) {
  const double limit_ms =
      chosen == no_row ? std::numeric_limits<double>::infinity() : faster_enough * table.rows[chosen].ms.median;
  std::vector<std::size_t> doubtful;
  for (const std::size_t i : rows_by_time(table)) {
    const TradeoffRow& row = table.rows[i];
    const bool kept = worst_rmse(row.views) <= max_rmse, promised = promise_of(row, frames_of_scene).rmse <= max_rmse;
    if (row.ms.median < limit_ms && kept && !promised) doubtful.push_back(i);
  }
  return doubtful;
}

BudgetChoice most_accurate_within(const TradeoffTable& table, int frames_of_scene, double max_ms) {
  const std::vector<Promise> promises = promises_of(table, frames_of_scene);
  const auto rows =
      rows_in_order(table, [&](std::size_t a, std::size_t b) { return promises[a].rmse < promises[b].rmse; });
  BudgetChoice choice;
  for (const std::size_t row : rows) {
    if (choice.nearest == no_row || promises[row].ms < promises[choice.nearest].ms) choice.nearest = row;
    if (promises[row].ms > max_ms) continue;
    choice.row = choice.nearest = row;
    break;
  }
  choice.promise = promises[choice.nearest];
  return choice;
}

std::vector<std::size_t> steps_of_accuracy(const TradeoffTable& table, int frames_of_scene) {
  const std::vector<Promise> promises = promises_of(table, frames_of_scene);
  const auto rows = rows_in_order(table, [&](std::size_t a, std::size_t b) {
    return promises[a].ms != promises[b].ms ? promises[a].ms < promises[b].ms : promises[a].rmse < promises[b].rmse;
  });
  std::vector<std::size_t> steps;
  for (const std::size_t row : rows)
    if (steps.empty() || promises[row].rmse < promises[steps.back()].rmse) steps.push_back(row);
  return steps;
}

std::vector<int> unused_frames(int frames_of_scene, const std::vector<int>& used, int count) {
  std::vector<int> left, chosen;
  for (int frame = 0; frame < frames_of_scene; ++frame)
    if (std::find(used.begin(), used.end(), frame) == used.end()) left.push_back(frame);
  const auto size = static_cast<std::int64_t>(left.size());
  const std::int64_t wanted = std::min<std::int64_t>(count, size);
  for (std::int64_t i = 0; i < wanted; ++i)
    chosen.push_back(left[static_cast<std::size_t>((2 * i + 1) * size / (2 * wanted))]);
  return chosen;
}

}  // namespace understory
