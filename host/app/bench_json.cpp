#include "host/app/bench_json.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

#include "host/app/device_json.hpp"
#include "sim/error.hpp"
#include "sim/files/json_fields.hpp"

namespace understory {
namespace {

using Json = nlohmann::ordered_json;

/// What `--compare` reads of an earlier run.
constexpr JsonFields compared_fields{
    JsonField{"name", &BenchResult::name}, JsonField{"median_ms", &BenchResult::median_ms},
    JsonField{"low_ms", &BenchResult::low_ms}, JsonField{"high_ms", &BenchResult::high_ms},
    JsonField{"verified", &BenchResult::verified}};

Json to_json(const BenchResult& result) {
  Json json = compared_fields.write(result);
  json.update({{"item", result.item},
               {"items", result.items},
               {"wall_ms", result.wall_ms},
               {"wall_low_ms", result.wall_low_ms},
               {"wall_high_ms", result.wall_high_ms},
               {"runs", result.runs},
               {"noisy", result.noisy},
               {"cold_ms", result.cold_ms},
               {"items_per_s", result.items_per_s},
               {"bytes_per_s", result.bytes_per_s},
               {"flop_per_s", result.flop_per_s},
               {"operations_per_byte", result.operations_per_byte},
               {"joules_per_item", result.joules_per_item},
               {"shares", result.shares},
               {"roof_share", result.roof_share},
               {"bound_by", result.bound_by},
               {"streams", result.streams},
               {"rest", result.rest},
               {"max_error", result.max_error}});
  for (const auto& [key, times] : {std::pair{"cold", result.cold}, std::pair{"warm", result.warm}})
    if (times) json[key] = {{"build_ms", times->build_ms}, {"first_launch_ms", times->first_launch_ms}};
  return json;
}

}  // namespace

Json bench_json(const std::vector<BenchReport>& reports) {
  Json all = Json::array();
  for (const BenchReport& report : reports) {
    Json results = Json::array();
    for (const BenchResult& result : report.results) results.push_back(to_json(result));
    all.push_back({{"device", device_json(report.device)},
                   {"energy", report.energy},
                   {"roofs", report.roofs},
                   {"results", results}});
  }
  Json first = all.front();
  all.erase(all.begin());
  if (!all.empty()) first["others"] = all;
  return first;
}

Json changes_json(const std::vector<BenchChange>& changes) {
  Json json = Json::array();
  for (const BenchChange& change : changes)
    json.push_back({{"name", change.name},
                    {"old_ms", change.old_ms},
                    {"new_ms", change.new_ms},
                    {"ratio", change.ratio},
                    {"low", change.low},
                    {"high", change.high},
                    {"verdict", verdict_name(change.verdict)}});
  return json;
}

Json errors_json(const ErrorStatistics& errors) {
  Json json = {{"pixels", errors.pixels},
               {"rmse", errors.rmse},
               {"rmse_denoised", errors.rmse_denoised},
               {"mae", errors.mae},
               {"bias", errors.bias},
               {"max", errors.max},
               {"p95", errors.p95},
               {"log_mae", errors.log_mae},
               {"reference_mean", errors.reference_mean},
               {"best_constant_rmse", errors.best_constant}};
  if (errors.inside >= 0) {
    json["inside_interval"] = errors.inside;
    json["truth_noise"] = errors.truth_noise;
  }
  return json;
}

Json accuracy_json(const AccuracyReport& report) {
  Json rows = Json::array(), truth = Json::array(), canopies = Json::array();
  for (const AccuracyRow& row : report.rows)
    rows.push_back({{"scene", row.scene},
                    {"setting", row.setting},
                    {"surface", row.surface},
                    {"method", row.method},
                    {"errors", errors_json(row.errors)}});
  for (const TruthRow& row : report.truth)
    truth.push_back({{"scene", row.scene},
                     {"setting", row.setting},
                     {"rays_per_s", row.rays_per_s},
                     {"rays", row.rays},
                     {"fragments", row.fragments},
                     {"inside", row.inside},
                     {"tenth_inside", row.tenth_inside},
                     {"tenth_fragments", row.tenth_fragments}});
  for (const CanopyTruth& canopy : report.canopies)
    canopies.push_back({{"leaf_area_index", canopy.leaf_area_index},
                        {"traced", canopy.traced},
                        {"standard_error", canopy.standard_error},
                        {"closed_form", canopy.closed_form}});
  return {{"device", report.device}, {"rays", report.rays},  {"rows", rows},
          {"truth", truth},          {"canopies", canopies}, {"unknown", report.unknown}};
}

std::vector<BenchResult> read_bench_results(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw Error(ErrorKind::input_output, file.string() + ": cannot be read");
  try {
    std::vector<BenchResult> results;
    const Json report = Json::parse(stream);
    for (const Json& json : report.at("results")) results.push_back(compared_fields.read(json));
    return results;
  } catch (const nlohmann::json::exception& error) {
    throw Error(ErrorKind::invalid_input,
                file.string() + ": not a report of `understory bench --json`: " + std::string(error.what()));
  }
}

}  // namespace understory
