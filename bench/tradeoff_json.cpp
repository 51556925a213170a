#include "bench/tradeoff_json.hpp"

#include <algorithm>

#include "bench/spread_json.hpp"
#include "sim/error.hpp"
#include "sim/files/scene_file.hpp"

namespace understory {
namespace {

using Json = nlohmann::ordered_json;

/// Everything under `methods`, as scene files write it.
Json methods_json(const Methods& methods) {
  Scene scene;
  scene.methods = methods;
  return Json::parse(resolved_scene(scene)).at("methods");
}

Methods methods_from_json(const Json& json) {
  std::vector<std::string> overrides;
  const Json keys = json.flatten();
  for (const auto& [pointer, value] : keys.items()) {
    std::string key = "methods" + pointer;
    std::replace(key.begin(), key.end(), '/', '.');
    overrides.push_back(key + "=" + (value.is_string() ? value.get<std::string>() : value.dump()));
  }
  return load_methods(overrides);
}

constexpr JsonFields error_fields{
    JsonField{"rmse", &RmseInterval::rmse},      JsonField{"rmse_low", &RmseInterval::low},
    JsonField{"rmse_high", &RmseInterval::high}, JsonField{"bias", &RmseInterval::bias},
    JsonField{"pixels", &RmseInterval::pixels},  JsonField{"truth_noise", &RmseInterval::truth_noise}};
constexpr JsonFields temporal_fields{JsonField{"rmse_dvdt", &TemporalError::rmse_dvdt},
                                     JsonField{"truth_dvdt", &TemporalError::truth_dvdt},
                                     JsonField{"flicker", &TemporalError::flicker}};
constexpr JsonFields prediction_fields{JsonField{"combinations", &PredictionQuality::combinations},
                                       JsonField{"measured", &PredictionQuality::measured},
                                       JsonField{"ms_bias", &PredictionQuality::ms_bias},
                                       JsonField{"ms_worst", &PredictionQuality::ms_worst},
                                       JsonField{"rmse_bias", &PredictionQuality::rmse_bias},
                                       JsonField{"rmse_worst", &PredictionQuality::rmse_worst}};

Json classes_json(const std::map<std::string, RmseInterval>& classes) {
  Json json = Json::object();
  for (const auto& [name, error] : classes) json[name] = error_fields.write(error);
  return json;
}

std::map<std::string, RmseInterval> classes_from_json(const Json& json) {
  std::map<std::string, RmseInterval> classes;
  for (const auto& [name, error] : json.items()) classes[name] = error_fields.read(error);
  return classes;
}

Json views_json(const std::vector<ViewError>& views) {
  Json all = Json::array();
  for (const ViewError& view : views) {
    Json one = {{"camera", view.camera}, {"frame", view.frame}};
    one.update(error_fields.write(view.all));
    one["classes"] = classes_json(view.classes);
    all.push_back(std::move(one));
  }
  return all;
}

/// Medians under one key, intervals under another.
void write_passes(Json& json, const char* medians, const char* intervals, const std::map<std::string, Spread95>& all) {
  json[medians] = json[intervals] = Json::object();
  for (const auto& [pass, ms] : all) {
    json[medians][pass] = ms.median;
    json[intervals][pass] = {ms.low, ms.high};
  }
}

std::map<std::string, Spread95> passes_from_json(const Json& json, const char* medians, const char* intervals) {
  std::map<std::string, Spread95> all;
  for (const auto& [pass, median] : json.at(medians).items()) {
    const Json& interval = json.at(intervals).at(pass);
    all[pass] = {median.get<double>(), interval.at(0).get<double>(), interval.at(1).get<double>()};
  }
  return all;
}

/// A number, or null for one that is not known.
Json known(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

std::optional<double> optional_number(const Json& json, const char* key) {
  return json.at(key).is_null() ? std::nullopt : std::optional(json.at(key).get<double>());
}

}  // namespace

Json row_json(const TradeoffRow& row) {
  Json json = {{"name", row.name},
               {"methods", methods_json(row.variant.methods)},
               {"shrink", row.variant.shrink},
               {"relaxed_maths", row.variant.relaxed_maths},
               {"settings", row.settings},
               {"verified", row.verified},
               {"failure", row.failure},
               {"ms", row.ms.median},
               {"ms_low", row.ms.low},
               {"ms_high", row.ms.high}};
  json.update(error_fields.write(row.error));
  json["mib"] = row.mib;
  json["pareto"] = row.pareto;
  json["ties"] = row.ties;
  json["wall_ms"] = spread_fields.write(row.wall_ms);
  json["frame_ms"] = row.frame_ms;
  write_passes(json, "pass_ms", "pass_interval_ms", row.pass_ms);
  write_passes(json, "pass_wall_ms", "pass_wall_interval_ms", row.pass_wall_ms);
  json["start_s"] = row.start_s;
  json["bake_s"] = row.bake_s < 0 ? Json(nullptr) : Json(row.bake_s);
  json["classes"] = classes_json(row.classes);
  json["views"] = views_json(row.views);
  json["temporal"] = row.temporal ? temporal_fields.write(*row.temporal) : Json(nullptr);
  json["predicted_ms"] = known(row.predicted_ms);
  json["predicted_rmse"] = known(row.predicted_rmse);
  return json;
}

TradeoffRow row_from_json(const Json& json) {
  TradeoffRow row;
  row.variant.methods = methods_from_json(json.at("methods"));
  json.at("shrink").get_to(row.variant.shrink);
  json.at("relaxed_maths").get_to(row.variant.relaxed_maths);
  json.at("name").get_to(row.name);
  json.at("settings").get_to(row.settings);
  json.at("verified").get_to(row.verified);
  json.at("failure").get_to(row.failure);
  row.ms = {json.at("ms").get<double>(), json.at("ms_low").get<double>(), json.at("ms_high").get<double>()};
  row.error = error_fields.read(json);
  json.at("mib").get_to(row.mib);
  json.at("pareto").get_to(row.pareto);
  json.at("ties").get_to(row.ties);
  row.wall_ms = spread_fields.read(json.at("wall_ms"));
  json.at("frame_ms").get_to(row.frame_ms);
  row.pass_ms = passes_from_json(json, "pass_ms", "pass_interval_ms");
  row.pass_wall_ms = passes_from_json(json, "pass_wall_ms", "pass_wall_interval_ms");
  json.at("start_s").get_to(row.start_s);
  row.bake_s = optional_number(json, "bake_s").value_or(-1);
  row.classes = classes_from_json(json.at("classes"));
  for (const Json& view : json.at("views"))
    row.views.push_back({view.at("camera").get<int>(), view.at("frame").get<int>(), error_fields.read(view),
                         classes_from_json(view.at("classes"))});
  if (const Json& temporal = json.at("temporal"); !temporal.is_null()) row.temporal = temporal_fields.read(temporal);
  row.predicted_ms = optional_number(json, "predicted_ms");
  row.predicted_rmse = optional_number(json, "predicted_rmse");
  return row;
}

std::string tradeoff_json(const TradeoffTable& table) {
  Json rows = Json::array(), drawing = Json::array();
  for (const TradeoffRow& row : table.rows) rows.push_back(row_json(row));
  for (const auto& [shrink, ms] : table.draw_ms) drawing.push_back({{"shrink", shrink}, {"ms", ms}});
  const Json json = {{"scene", table.scene},
                     {"device", table.device},
                     {"identity", table.identity},
                     {"frames", table.frames},
                     {"cameras", table.cameras},
                     {"pixels", table.pixels},
                     {"rays", table.rays},
                     {"draw_ms", drawing},
                     {"prediction", prediction_fields.write(table.prediction)},
                     {"rows", rows}};
  return json.dump(1) + "\n";
}

TradeoffTable read_tradeoff(const std::string& text, const std::string& where) {
  try {
    const Json json = Json::parse(text);
    TradeoffTable table;
    json.at("scene").get_to(table.scene);
    json.at("device").get_to(table.device);
    json.at("identity").get_to(table.identity);
    json.at("frames").get_to(table.frames);
    json.at("cameras").get_to(table.cameras);
    json.at("pixels").get_to(table.pixels);
    json.at("rays").get_to(table.rays);
    for (const Json& drawing : json.at("draw_ms"))
      table.draw_ms[drawing.at("shrink").get<int>()] = drawing.at("ms").get<double>();
    prediction_fields.read(json.at("prediction"), table.prediction);
    for (const Json& row : json.at("rows")) table.rows.push_back(row_from_json(row));
    return table;
  } catch (const nlohmann::json::exception& error) {
    throw Error(ErrorKind::invalid_input,
                where + ": not a table of `understory tradeoff`: " + std::string(error.what()));
  }
}

}  // namespace understory
