// How far a run is and how long it will take, on standard error: a bar on a terminal, now and then a line elsewhere.
#pragma once
#include <chrono>
#include <string>

namespace understory {

class Progress {
 public:
  /// `total` steps of which `done_before` need no work (a resumed run). `quiet`: prints nothing.
  Progress(int total, int done_before, bool quiet);
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void advance(const std::string& step_name);
  /// The same when it turns out that there are so many steps in all.
  void advance(int total, const std::string& step_name);
  /// Removes the bar so that a message can take its line.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  int total_, done_, done_before_;
  bool quiet_, terminal_, bar_shown_ = false;
  Clock::time_point started_, line_printed_;
  int percent_printed_ = 0;
};

/// "0:07", "12:05", "3:04:05".
std::string clock_text(double seconds);

/// One line: bar of `width` cells, share, steps, rate and time left; `step_seconds` <= 0: not known yet.
std::string progress_text(int done, int total, double step_seconds, const std::string& step_name, int width);

}  // namespace understory
