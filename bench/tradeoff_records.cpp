#include "bench/tradeoff_records.hpp"

#include <algorithm>
#include <chrono>

#include "host/frame/occluder_grids.hpp"
#include "host/trace/bake_cache.hpp"
#include "sim/error.hpp"

namespace understory {
namespace {

double seconds_of(const std::function<void()>& action) {
  const auto started = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
}

/// What has to be baked before these methods run, as a key; empty: nothing.
std::string bakes_of(const Methods& methods) {
  std::string bakes;
  if (methods.tree == "crown-field" || methods.tree == "crown-baked") bakes += methods.tree;
  if (is_grid_method(methods.occluders)) bakes += "grid" + std::to_string(methods.grid.size);
  return bakes;
}

void append(const std::vector<double>& more, std::vector<double>& all) {
  all.insert(all.end(), more.begin(), more.end());
}

void append(const ShadingSamples& more, ShadingSamples& all) {
  all.draw_ms = all.device_ms.empty() ? more.draw_ms : 0.5 * (all.draw_ms + more.draw_ms);
  append(more.device_ms, all.device_ms);
  append(more.wall_ms, all.wall_ms);
  for (const auto& [pass, milliseconds] : more.pass_ms) append(milliseconds, all.pass_ms[pass]);
  for (const auto& [pass, milliseconds] : more.pass_wall_ms) append(milliseconds, all.pass_wall_ms[pass]);
}

}  // namespace

VariantRecords::VariantRecords(Device& device, TradeoffJudge& judge, const TradeoffOptions& options,
                               const ImageSize& image)
    : device_(device),
      judge_(judge),
      options_(options),
      image_(image),
      store_(options.folder.empty() ? options.folder : options.folder / "variants", options.identity) {}

/// Builds the variant twice: from warm caches the second time, and from no bakes at all the first where that is asked.
void VariantRecords::measure(VariantRecord& record) {
  TradeoffRow& row = record.row;
  const std::string bakes = bakes_of(row.variant.methods);
  const bool fresh = options_.bakes && !bakes.empty() && !baked_.contains(bakes);
  double first_s = 0;
  if (fresh) {
    const FreshBakes none_kept;
    first_s = seconds_of([&] { judge_.choose(row.variant); });
  } else {
    judge_.choose(row.variant);
  }
  row.start_s = seconds_of([&] { judge_.choose(row.variant); });
  if (fresh) row.bake_s = std::max(0.0, first_s - row.start_s);
  try {
    record.values = judge_.values(options_.rounds, &record.samples);
    row.verified = true;
  } catch (const Error& error) {  // a wrong picture has no speed
    row.failure = error.what();
    return;
  }
  row.mib = static_cast<double>(device_.buffer_bytes()) / (1 << 20);
  row.error = judge_.error(record.values.visibility);
  row.classes = judge_.class_errors(record.values.visibility);
  row.views = judge_.view_errors(record.values.visibility);
  record.sweeps = 1;
}

VariantRecord& VariantRecords::measured(const Variant& variant) {
  const std::string name = variant.name();
  if (const auto found = records_.find(name); found != records_.end()) return found->second;
  std::optional<VariantRecord> record = store_.load(name);
  if (!record) {
    record.emplace();
    record->row.variant = variant;
    record->row.name = name;
    record->row.settings = variant.settings(image_);
    measure(*record);
    store_.save(*record);
  }
  if (record->row.bake_s >= 0) baked_.insert(bakes_of(variant.methods));
  return records_.emplace(name, std::move(*record)).first->second;
}

void VariantRecords::judge_in_time(VariantRecord& record) {
  if (options_.runnable_only || record.row.temporal || !record.row.verified) return;
  judge_.choose(record.row.variant);
  record.row.temporal = judge_.temporal_error(record.values.visibility, judge_.following());
  store_.save(record);
}

void VariantRecords::time_once_more(VariantRecord& record) {
  judge_.choose(record.row.variant);
  append(judge_.time(options_.rounds), record.samples);
  ++record.sweeps;
  store_.save(record);
}

}  // namespace understory
