// Prints progress on standard error only: standard output carries results.
#include "host/app/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace understory {
namespace {

constexpr double line_every_seconds = 10;
constexpr int line_every_percent = 5;
constexpr int bar_cells = 24;

bool stderr_is_terminal() {
  const char* terminal = std::getenv("TERM");
  return isatty(STDERR_FILENO) && terminal && std::string_view(terminal) != "dumb";
}

double seconds_since(std::chrono::steady_clock::time_point then) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - then).count();
}

}  // namespace

std::string clock_text(double seconds) {
  const long whole = std::lround(std::clamp(seconds, 0.0, 359'999'999.0));
  const long hours = whole / 3600, minutes = whole / 60 % 60;
  return hours > 0 ? fmt::format("{}:{:02}:{:02}", hours, minutes, whole % 60)
                   : fmt::format("{}:{:02}", minutes, whole % 60);
}

std::string progress_text(int done, int total, double step_seconds, const std::string& step_name, int width) {
  std::string text;
  if (width > 0) {
    const int filled = total > 0 ? static_cast<int>(static_cast<long>(width) * done / total) : width;
    text = '[' + std::string(filled, '#') + std::string(width - filled, '.') + "] ";
  }
  text += fmt::format("{:3} %  {}/{} {}", total > 0 ? 100L * done / total : 100L, done, total, step_name);
  if (step_seconds <= 0) return text;
  text += step_seconds < 1 ? fmt::format("  {:.1f}/s", 1 / step_seconds) : fmt::format("  {:.1f} s each", step_seconds);
  return text + "  left " + clock_text(step_seconds * (total - done));
}

Progress::Progress(int total, int done_before, bool quiet)
    : total_(total),
      done_(done_before),
      done_before_(done_before),
      quiet_(quiet),
      terminal_(stderr_is_terminal()),
      started_(Clock::now()),
      line_printed_(started_),
      percent_printed_(total > 0 ? static_cast<int>(100L * done_before / total) : 0) {}

void Progress::advance(const std::string& step_name) {
  ++done_;
  if (quiet_) return;
  const int worked = done_ - done_before_;
  const double step_seconds = seconds_since(started_) / worked;
  if (terminal_) {
    fmt::print(stderr, "\r\x1b[K{}", progress_text(done_, total_, step_seconds, step_name, bar_cells));
    std::fflush(stderr);
    bar_shown_ = true;
    return;
  }
  const int percent = total_ > 0 ? static_cast<int>(100L * done_ / total_) : 100;
  const bool due =
      percent >= percent_printed_ + line_every_percent || seconds_since(line_printed_) >= line_every_seconds;
  if (!due && done_ < total_) return;
  fmt::print(stderr, "{}\n", progress_text(done_, total_, step_seconds, step_name, 0));
  percent_printed_ = percent;
  line_printed_ = Clock::now();
}

void Progress::advance(int total, const std::string& step_name) {
  total_ = total;
  advance(step_name);
}

void Progress::clear() {
  if (!bar_shown_) return;
  fmt::print(stderr, "\r\x1b[K");
  std::fflush(stderr);
  bar_shown_ = false;
}

}  // namespace understory
