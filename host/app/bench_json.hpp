// A bench report as the JSON of `bench --json`, and the results of such a file for `--compare`.
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "bench/accuracy.hpp"
#include "bench/report.hpp"

namespace understory {

/// Keys as in DESIGN.md, "What machines read", and what else BenchResult holds beside them. Of several devices the
/// first, the rest under `others`.
nlohmann::ordered_json bench_json(const std::vector<BenchReport>& reports);

/// [{name, old_ms, new_ms, ratio, low, high, verdict}]
nlohmann::ordered_json changes_json(const std::vector<BenchChange>& changes);

/// Keys as in `compare --json`.
nlohmann::ordered_json errors_json(const ErrorStatistics& errors);

/// {device, rays, rows [{scene, setting, surface, method, errors}], truth, canopies, unknown} of `bench --accuracy`.
nlohmann::ordered_json accuracy_json(const AccuracyReport& report);

/// Names, times and verdicts of the results in a file that bench_json wrote. Throws Error(input_output) for a file that
/// cannot be read, Error(invalid_input) for one that is something else.
std::vector<BenchResult> read_bench_results(const std::filesystem::path& file);

}  // namespace understory
