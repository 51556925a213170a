// `understory bench --accuracy` and `--grids`: errors against traced truth instead of times.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "bench/accuracy.hpp"

namespace understory {

/// Into the Markdown file `table` (-: only printed); `json`: printed as JSON. Throws Error(usage) without
/// UNDERSTORY_DATA. Returns the exit code.
int bench_accuracy(const std::string& table, AccuracyOptions options, bool json);

/// Errors of the methods of moving bodies in `scenes` into `table` (-: printed). Throws Error(usage) without scenes.
int bench_grid_errors(const std::string& table, const std::string& device,
                      const std::vector<std::filesystem::path>& scenes);

}  // namespace understory
