// Which of several choices of methods the next frame is shaded with so that frames keep a time: steps down when they
// get too slow, and up again only when that will hold. It knows nothing of clocks: it is told what frames took.
#pragma once
#include <cstddef>
#include <vector>

namespace understory {

class Pace {
 public:
  /// `predicted_ms`: of a frame with each choice, ascending, more than 0, at least one; `max_ms` > 0: what a frame may
  /// take. Starts with the slowest choice that is predicted to fit, or the fastest. Throws Error(unexpected).
  Pace(std::vector<double> predicted_ms, double max_ms);

  /// The choice for the next frame.
  std::size_t level() const { return level_; }
  /// How often the choice has changed.
  std::size_t switches() const { return switches_; }
  /// Tells what the last frame took, with the choice that level() named. The first after a change is not counted: it
  /// touches new memory.
  void add(double ms);

 private:
  double expected_ms(std::size_t level) const { return load_ * predicted_ms_[level]; }
  void go_to(std::size_t level);

  std::vector<double> predicted_ms_;
  double max_ms_;
  std::size_t level_ = 0, switches_ = 0;
  double load_ = 1;            // what frames take over what was predicted, smoothed
  double scatter_ = 0;         // mean |deviation| of single frames from that, as a share of it, smoothed
  int frames_ = 0;             // counted since the last change
  int roomy_ = 0;              // in a row for which the next choice would have fitted
  std::vector<int> patience_;  // per choice: such frames in a row before it is tried; doubles when it did not hold
  bool cold_ = true;
};

}  // namespace understory
