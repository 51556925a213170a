// Rows of a tradeoff as JSON, for tradeoff.json and for what is kept of a variant that has been measured.
#pragma once
#include <nlohmann/json.hpp>

#include "bench/tradeoff.hpp"

namespace understory {

nlohmann::ordered_json row_json(const TradeoffRow& row);
/// Throws nlohmann::json::exception or Error(invalid_input) for what is no row.
TradeoffRow row_from_json(const nlohmann::ordered_json& json);

}  // namespace understory
