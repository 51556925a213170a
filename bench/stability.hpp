// `understory stability`: every kernel over the extremes of its inputs, device float against double; finite, within
// [0, 1], monotone and continuous where the mathematics says so. The same with -cl-fast-relaxed-math, which is never
// the default.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "host/opencl/device.hpp"

namespace understory {

/// Largest |error| of V beside what tables and fits state: in the normal domain, and at the extremes.
inline constexpr double normal_bar = 2e-6, extreme_bar = 1e-4;

struct StabilityRow {
  std::string kernel, name;  // name: of the case
  bool extreme = false;
  std::size_t values = 0;
  bool finite = true, in_range = true;
  double lowest = 1, highest = 0;       // V: what the case covers
  std::optional<double> max_abs_error;  // against double; none: nothing to compare with
  double bar = 0;                       // what max_abs_error may be: normal_bar or extreme_bar and the stated error
  double stated_error = 0;              // of tables and fits
  double last_place = 0;                // of the worst value: what one unit in the last place of its inputs changes
  std::optional<double> largest_jump;   // of V over one unit in the last place across a branch, beyond its slope
  std::optional<double> largest_fall;   // of V where it must not fall
  std::string note;                     // what the stated error is of
  std::string reason;                   // of what exceeds the bar, else the note
  bool passed = true;
  std::map<std::uint32_t, std::uint64_t> validity;  // code (a single bit) -> values that carry it
  // With -cl-fast-relaxed-math: measured, nothing is required.
  std::optional<double> relaxed_max_abs_error;
  bool relaxed_finite = true, relaxed_in_range = true;
};

struct StabilityReport {
  DeviceInfo device;
  std::vector<StabilityRow> rows;
  bool relaxed = false;  // the relaxed columns were measured
  std::size_t failures() const;
};

struct StabilityOptions {
  std::size_t samples = 2000;  // fragments of a case that is made by chance
  bool relaxed = true;         // measure the relaxed build as well
  std::string filter;          // kernels whose name contains it; empty: all
  /// Called after each case with how many there are, and its kernel.
  std::function<void(std::size_t, const std::string&)> progress = {};
};

StabilityReport run_stability(const std::string& device, const StabilityOptions& options);

/// stability.json and stability.md. Same device and build: same text.
std::string stability_json(const StabilityReport& report);
std::string stability_markdown(const StabilityReport& report);

}  // namespace understory
