// What `run` tells on standard output when it ends: where things are, and where the time went.
#pragma once
#include <filesystem>
#include <string>

#include "host/app/run_record.hpp"

namespace understory {

/// Kinds of files with their first and last names and their number; then the median milliseconds of each pass over the
/// frames, their sum, and the whole frame's wall time.
std::string run_summary(const std::filesystem::path& folder, const RunRecord& record);

/// Median; 0 for an empty list.
double median(std::vector<double> values);

}  // namespace understory
