// Run records to and from JSON; keys as in DESIGN.md, "What machines read".
#include "host/app/run_record.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "sim/error.hpp"
#include "sim/files/json_fields.hpp"

namespace understory {
namespace {

using Json = nlohmann::ordered_json;

constexpr JsonFields frame_fields{JsonField{"index", &FrameRecord::index},   JsonField{"time_s", &FrameRecord::time_s},
                                  JsonField{"ms", &FrameRecord::ms},         JsonField{"passes", &FrameRecord::passes},
                                  JsonField{"sha256", &FrameRecord::sha256}, JsonField{"files", &FrameRecord::files}};
constexpr JsonFields budget_fields{
    JsonField{"max_error", &BudgetRecord::max_error},     JsonField{"max_ms", &BudgetRecord::max_ms},
    JsonField{"choice", &BudgetRecord::choice},           JsonField{"promised_rmse", &BudgetRecord::promised_rmse},
    JsonField{"promised_ms", &BudgetRecord::promised_ms}, JsonField{"chosen_by", &BudgetRecord::chosen_by},
    JsonField{"checked_on", &BudgetRecord::checked_on},   JsonField{"found_rmse", &BudgetRecord::found_rmse}};

Json to_json(const FrameRecord& frame) {
  Json validity = Json::object();
  for (const auto& [code, count] : frame.validity) validity[std::to_string(code)] = count;
  Json json = frame_fields.write(frame);
  json["validity"] = validity;
  if (!frame.chosen.empty()) json["chosen"] = frame.chosen;
  return json;
}

FrameRecord frame_from_json(const Json& json) {
  FrameRecord frame = frame_fields.read(json);
  frame.chosen = json.value("chosen", "");
  for (const auto& [code, count] : json.at("validity").items())
    frame.validity[static_cast<std::uint32_t>(std::stoul(code))] = count.get<std::uint64_t>();
  return frame;
}

std::string budget_text(const RunRecord& record) {
  if (!record.budget) return "none";
  if (record.budget->max_error > 0) return fmt::format("--max-error {:g}", record.budget->max_error);
  return fmt::format("--max-ms {:g}", record.budget->max_ms);
}

Json validity_of_all(const RunRecord& record) {
  std::map<std::uint32_t, std::uint64_t> counts;
  for (const auto& [index, frame] : record.frames)
    for (const auto& [code, count] : frame.validity) counts[code] += count;
  Json json = Json::object();
  for (const auto& [code, count] : counts) json[std::to_string(code)] = count;
  return json;
}

/// The part of a device's description that decides results; its memory and free threads change from start to start.
std::string device_identity(const std::string& device) {
  if (device.empty()) return "";
  const Json all = Json::parse(device);
  Json kept = Json::object();
  for (const char* key : {"platform", "name", "version", "driver", "vector_width", "atomic64"})
    if (all.contains(key)) kept[key] = all.at(key);
  return kept.dump();
}

/// The keys that must agree, by name.
std::vector<std::pair<std::string, std::string>> identity(const RunRecord& record) {
  return {{"version", record.version},
          {"program (SHA-256 of the executable)", record.program_sha256},
          {"scene (with --set and the method options)", record.scene_sha256},
          {"input files", Json(record.inputs).dump()},
          {"device", device_identity(record.device)},
          {"budget", budget_text(record)},
          {"size", fmt::format("{}x{}", record.width, record.height)},
          {"supersample", std::to_string(record.supersample)},
          {"dump", fmt::format("{}", fmt::join(record.dumps, ","))}};
}

template <typename Parse>
auto parse_json(const std::string& text, const std::string& where, Parse parse) {
  try {
    return parse(Json::parse(text));
  } catch (const std::exception& error) {  // nlohmann's and std::stoul's
    throw Error(ErrorKind::invalid_input, fmt::format("{}: not a record of a run: {}", where, error.what()));
  }
}

}  // namespace

std::vector<std::string> differences(const RunRecord& earlier, const RunRecord& now) {
  std::vector<std::string> lines;
  const auto before = identity(earlier), after = identity(now);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const bool undecided = before[i].second.empty() || after[i].second.empty();
    if (!undecided && before[i].second != after[i].second)
      lines.push_back(fmt::format("{} was {}, is {}", before[i].first, before[i].second, after[i].second));
  }
  return lines;
}

bool is_adaptive(const RunRecord& record) { return record.budget && record.budget->max_ms > 0; }

std::string to_json_text(const RunRecord& record) {
  Json json = {{"understory", record.version},
               {"program_sha256", record.program_sha256},
               {"complete", record.complete},
               {"scene", record.scene},
               {"scene_sha256", record.scene_sha256},
               {"inputs", record.inputs},
               {"seed", record.seed},
               {"device", record.device.empty() ? Json(nullptr) : Json::parse(record.device)},
               {"size", {record.width, record.height}},
               {"supersample", record.supersample},
               {"dump", record.dumps},
               {"methods", record.methods},
               {"adaptive", is_adaptive(record)},
               {"plan", record.plan},
               {"programs", record.programs},
               {"peak_rss_mib", record.peak_rss_mib},
               {"validity", validity_of_all(record)}};
  if (record.budget) json["budget"] = budget_fields.write(*record.budget);
  Json frames = Json::array(), failed = Json::array();
  for (const auto& [index, frame] : record.frames) frames.push_back(to_json(frame));
  for (const FailedFrame& frame : record.failed) failed.push_back({{"index", frame.index}, {"message", frame.message}});
  json["failed"] = failed;
  json["frames"] = frames;
  return json.dump(2) + '\n';
}

std::string to_json_line(const FrameRecord& frame) { return to_json(frame).dump() + '\n'; }

RunRecord parse_run_record(const std::string& text, const std::string& where) {
  return parse_json(text, where, [](const Json& json) {
    RunRecord record;
    json.at("understory").get_to(record.version);
    json.at("program_sha256").get_to(record.program_sha256);
    json.at("complete").get_to(record.complete);
    json.at("scene").get_to(record.scene);
    json.at("scene_sha256").get_to(record.scene_sha256);
    json.at("inputs").get_to(record.inputs);
    json.at("seed").get_to(record.seed);
    if (!json.at("device").is_null()) record.device = json.at("device").dump();
    json.at("size").at(0).get_to(record.width);
    json.at("size").at(1).get_to(record.height);
    json.at("supersample").get_to(record.supersample);
    json.at("dump").get_to(record.dumps);
    json.at("methods").get_to(record.methods);
    if (json.contains("budget")) record.budget = budget_fields.read(json.at("budget"));
    json.at("plan").get_to(record.plan);
    json.at("programs").get_to(record.programs);
    json.at("peak_rss_mib").get_to(record.peak_rss_mib);
    for (const Json& frame : json.at("frames")) {
      const FrameRecord parsed = frame_from_json(frame);
      record.frames[parsed.index] = parsed;
    }
    return record;
  });
}

FrameRecord parse_frame_record(const std::string& line, const std::string& where) {
  return parse_json(line, where, frame_from_json);
}

}  // namespace understory
