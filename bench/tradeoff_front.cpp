#include <algorithm>

#include "bench/tradeoff.hpp"

namespace understory {
namespace {

bool clearly_faster(const TradeoffRow& a, const TradeoffRow& b) { return a.ms.high < b.ms.low; }
bool clearly_better(const TradeoffRow& a, const TradeoffRow& b) { return a.error.high < b.error.low; }

bool beats(const TradeoffRow& a, const TradeoffRow& b) {
  return (clearly_faster(a, b) && !clearly_better(b, a)) || (clearly_better(a, b) && !clearly_faster(b, a));
}

/// Without intervals: no worse in both, better in one.
bool beats_by_medians(const TradeoffRow& a, const TradeoffRow& b) {
  return a.ms.median <= b.ms.median && a.error.rmse <= b.error.rmse &&
         (a.ms.median < b.ms.median || a.error.rmse < b.error.rmse);
}

}  // namespace

void mark_front(std::vector<TradeoffRow>& rows) {
  for (TradeoffRow& row : rows) {
    row.ties.clear();
    for (const TradeoffRow& other : rows) {
      const bool apart = clearly_faster(row, other) || clearly_faster(other, row) || clearly_better(row, other) ||
                         clearly_better(other, row);
      if (&other != &row && row.verified && other.verified && !apart) row.ties.push_back(other.name);
    }
  }
  std::vector<TradeoffRow*> open;
  for (TradeoffRow& row : rows) {
    row.pareto = false;
    if (row.verified) open.push_back(&row);
  }
  while (!open.empty()) {
    const auto unbeaten = [&](const auto& is_beaten_by) {
      return std::find_if(open.begin(), open.end(), [&](const TradeoffRow* row) {
        return std::none_of(open.begin(), open.end(),
                            [&](const TradeoffRow* other) { return is_beaten_by(*other, *row); });
      });
    };
    auto next = unbeaten(beats);
    // Wide intervals can beat each other in a circle of four that leaves nobody; then the medians decide.
    if (next == open.end()) next = unbeaten(beats_by_medians);
    TradeoffRow& winner = **next;
    winner.pareto = true;
    std::erase_if(open, [&](const TradeoffRow* row) { return row == &winner || beats(winner, *row); });
  }
}

}  // namespace understory
