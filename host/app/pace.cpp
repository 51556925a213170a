// Smoothing, a dead band as wide as frames scatter, and patience that doubles with every failure: after n frames there
// have been at most about log2(n) attempts at each choice that does not hold.
#include "host/app/pace.hpp"

#include <algorithm>
#include <cmath>

#include "sim/error.hpp"

namespace understory {
namespace {

constexpr double smoothing = 0.25;      // weight of the newest frame: half of it is of the last three
constexpr int settling = 4;             // frames before a choice is judged
constexpr int first_patience = 8;       // frames in a row
constexpr int most_patience = 1 << 20;  // frames; a day at 12 a second
constexpr double least_margin = 0.05;   // share of max_ms that a slower choice must leave free

}  // namespace

Pace::Pace(std::vector<double> predicted_ms, double max_ms)
    : predicted_ms_(std::move(predicted_ms)), max_ms_(max_ms), patience_(predicted_ms_.size(), first_patience) {
  if (predicted_ms_.empty() || !(predicted_ms_.front() > 0) ||
      !std::is_sorted(predicted_ms_.begin(), predicted_ms_.end()) || !(max_ms > 0))
    throw Error(ErrorKind::unexpected, "pace: needs times above 0 in ascending order");
  while (level_ + 1 < predicted_ms_.size() && predicted_ms_[level_ + 1] <= max_ms_) ++level_;
}

void Pace::go_to(std::size_t level) {
  level_ = level;
  ++switches_;
  frames_ = roomy_ = 0;
  cold_ = true;
}

void Pace::add(double ms) {
  if (cold_) {
    cold_ = false;
    return;
  }
  const double load = ms / predicted_ms_[level_];
  if (frames_ == 0) load_ = load;
  const double weight = std::max(smoothing, 1.0 / ++frames_);
  load_ += weight * (load - load_);
  scatter_ += weight * (std::abs(load / load_ - 1) - scatter_);
  if (frames_ < settling) return;
  if (expected_ms(level_) > max_ms_ && level_ > 0) {
    // Whoever comes back here waits twice as long.
    patience_[level_] = std::min(2 * patience_[level_], most_patience);
    std::size_t lower = level_ - 1;
    while (lower > 0 && expected_ms(lower) > max_ms_) --lower;
    return go_to(lower);
  }
  if (level_ + 1 == predicted_ms_.size()) return;
  const double margin = std::max(least_margin, 2 * scatter_);
  roomy_ = expected_ms(level_ + 1) <= (1 - margin) * max_ms_ ? roomy_ + 1 : 0;
  if (roomy_ >= patience_[level_ + 1]) go_to(level_ + 1);
}

}  // namespace understory
