// Calibrations as JSON: what `calibrate --json` prints.
#pragma once
#include <nlohmann/json.hpp>

#include "host/trace/calibrate.hpp"

namespace understory {

/// Keys of `calibrate --json`.
nlohmann::ordered_json calibration_json(const Prototype& prototype, const Calibration& calibration);

}  // namespace understory
