// Reports of `understory bench` for people, and as comma-separated values.
#pragma once
#include <string>
#include <vector>

#include "bench/report.hpp"

namespace understory {

/// Device, roofs and results as tables; below them what to keep in mind when reading them.
std::string bench_text(const BenchReport& report, double precision);

/// Medians of the same names on several devices, and how many times faster the fastest is than the first.
std::string side_by_side_text(const std::vector<BenchReport>& reports);

std::string changes_text(const std::vector<BenchChange>& changes);

/// One header line, one line a result; units in the column names. Empty: not known.
std::string bench_csv(const std::vector<BenchReport>& reports);

}  // namespace understory
