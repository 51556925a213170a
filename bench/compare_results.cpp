// What changed between two reports.
#include <algorithm>

#include "bench/report.hpp"

namespace understory {
namespace {

BenchChange::Verdict judge(double ratio, double low, double high) {
  using Verdict = BenchChange::Verdict;
  if (low >= 1 - same_within && high <= 1 + same_within) return Verdict::same;
  if (low > 1 && ratio > 1 + same_within) return Verdict::slower;
  if (high < 1 && ratio < 1 - same_within) return Verdict::faster;
  return Verdict::undecided;
}

}  // namespace

std::string verdict_name(BenchChange::Verdict verdict) {
  switch (verdict) {
    case BenchChange::Verdict::faster:
      return "faster";
    case BenchChange::Verdict::slower:
      return "slower";
    case BenchChange::Verdict::same:
      return "same";
    case BenchChange::Verdict::undecided:
      break;
  }
  return "undecided";
}

std::vector<BenchChange> compare_results(const std::vector<BenchResult>& then, const std::vector<BenchResult>& now) {
  std::vector<BenchChange> changes;
  for (const BenchResult& result : now) {
    const auto old =
        std::find_if(then.begin(), then.end(), [&](const BenchResult& r) { return r.name == result.name; });
    const auto is_timed = [](const BenchResult& r) { return r.verified && r.low_ms > 0 && r.high_ms > 0; };
    if (old == then.end() || !is_timed(*old) || !is_timed(result)) continue;
    BenchChange change;
    change.name = result.name;
    change.old_ms = old->median_ms;
    change.new_ms = result.median_ms;
    change.ratio = result.median_ms / old->median_ms;
    change.low = result.low_ms / old->high_ms;
    change.high = result.high_ms / old->low_ms;
    change.verdict = judge(change.ratio, change.low, change.high);
    changes.push_back(change);
  }
  return changes;
}

}  // namespace understory
