#include "bench/budget_check.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <thread>

#include "bench/tradeoff_judge.hpp"
#include "host/trace/bake_cache.hpp"

namespace understory {
namespace {

ContentHash hash_of(const TradeoffOptions& options) {
  ContentHash hash;
  hash.add(options.identity);
  for (const int number : {options.frames, static_cast<int>(options.pixels), options.rays, options.rounds,
                           options.sweeps, options.combinations})
    hash.add(number);
  return hash;
}

/// Held by the process that measures: others that want the same wait for its table instead of disturbing its clocks.
/// Goes with the process, however it ends.
class MeasuringLock {
 public:
  MeasuringLock() = default;
  /// Waits until the lock is free or `stopped` says so. A file that cannot be made is no reason not to measure.
  void take(const std::filesystem::path& file, const std::function<bool()>& stopped) {
    descriptor_ = ::open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600);
    while (descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK &&
           !(stopped && stopped()))
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  ~MeasuringLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  MeasuringLock(const MeasuringLock&) = delete;
  MeasuringLock& operator=(const MeasuringLock&) = delete;

 private:
  int descriptor_ = -1;
};

double worst_of(const std::vector<ViewError>& views) {
  double worst = 0;
  for (const ViewError& view : views) worst = std::max(worst, view.all.high);
  return worst;
}

/// Looks at frames that the row was not judged by, and adds what is found to what it is judged by.
void check(TradeoffTable& table, int frames_of_scene, ErrorsOnFrames& errors, CheckedChoice& checked) {
  TradeoffRow& row = table.rows.at(checked.choice.row);
  std::vector<int> used;
  for (const ViewError& view : row.views) used.push_back(view.frame);
  checked.frames = unused_frames(frames_of_scene, used, frames_to_check);
  checked.found_rmse = 0;
  if (checked.frames.empty()) return;
  const std::vector<ViewError>& found = errors.of(row, checked.frames);
  checked.found_rmse = worst_of(found);
  row.views.insert(row.views.end(), found.begin(), found.end());
}

}  // namespace

TradeoffOptions measuring_for_budget(const std::string& identity) {
  TradeoffOptions options;
  options.identity = identity;
  options.frames = frames_to_choose_by;
  options.rays = 256;
  options.rounds = 5;
  options.sweeps = 1;
  options.combinations = 12;
  options.bakes = false;
  options.runnable_only = true;
  return options;
}

TradeoffTable tradeoff_for_budget(Device& device, World& world, TradeoffOptions options) {
  const ContentHash hash = hash_of(options);
  const std::filesystem::path folder = bake_cache_folder();
  MeasuringLock lock;
  for (int look = 0; look < 2; ++look) {  // and once more when others may have measured it meanwhile
    if (const std::optional<std::string> kept = load_bake("tradeoff", hash))
      return read_tradeoff(*kept, "the kept tradeoff of " + world.scene.name);
    if (look == 0 && !folder.empty()) lock.take(folder / "tradeoff.lock", options.stopped);
  }
  // Variants are kept one by one meanwhile, so that an interrupted measurement goes on.
  if (!folder.empty()) options.folder = folder / ("tradeoff-" + hash.text());
  TradeoffTable table = measure_tradeoff(device, world, options);
  if (options.stopped && options.stopped()) return table;
  store_bake("tradeoff", hash, tradeoff_json(table));
  std::error_code ignored;
  if (!options.folder.empty()) std::filesystem::remove_all(options.folder, ignored);
  return table;
}

void ErrorsOnFrames::look_at(const std::vector<const TradeoffRow*>& rows, const std::vector<int>& frames) {
  std::vector<const TradeoffRow*> unknown;
  for (const TradeoffRow* row : rows)
    if (!found_.contains({frames, row->name})) unknown.push_back(row);
  if (unknown.empty()) return;
  TradeoffJudge judge(device_, world_, {frames, options_.pixels, options_.rays, false});
  for (const TradeoffRow* row : unknown) {
    judge.choose(row->variant);
    found_[{frames, row->name}] = judge.view_errors(judge.values().visibility);
  }
}

const std::vector<ViewError>& ErrorsOnFrames::of(const TradeoffRow& row, const std::vector<int>& frames) {
  look_at({&row}, frames);
  return found_.at({frames, row.name});
}

CheckedChoice choose_within_error(TradeoffTable& table, int frames_of_scene, double max_rmse, ErrorsOnFrames& errors) {
  CheckedChoice checked;
  do {
    checked.choice = cheapest_within(table, frames_of_scene, max_rmse);
    if (checked.choice.row == no_row) return checked;
    check(table, frames_of_scene, errors, checked);
  } while (checked.found_rmse > max_rmse);  // ends: the row is promised no less than what was found
  return checked;
}

CheckedChoice choose_within_time(TradeoffTable& table, int frames_of_scene, double max_ms, ErrorsOnFrames& errors) {
  CheckedChoice checked;
  checked.choice = most_accurate_within(table, frames_of_scene, max_ms);
  if (checked.choice.row != no_row) check(table, frames_of_scene, errors, checked);
  return checked;
}

}  // namespace understory
