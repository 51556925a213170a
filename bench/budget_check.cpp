#include "bench/budget_check.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <thread>

#include "bench/tradeoff_judge.hpp"
#include "host/trace/bake_cache.hpp"

namespace understory {
namespace {

constexpr int looks_at_doubtful = 2;  // further looks, each at frames_to_check frames

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

/// Frames that the row has not been judged by.
std::vector<int> fresh_frames(const TradeoffRow& row, int frames_of_scene) {
  std::vector<int> used;
  for (const ViewError& view : row.views) used.push_back(view.frame);
  return unused_frames(frames_of_scene, used, frames_to_check);
}

/// Looks at such frames, adds what is found to what the row is judged by, and returns the largest error there.
double look_further(TradeoffRow& row, const std::vector<int>& frames, ErrorsOnFrames& errors) {
  if (frames.empty()) return 0;
  const std::vector<ViewError>& found = errors.of(row, frames);
  row.views.insert(row.views.end(), found.begin(), found.end());
  return worst_rmse(found);
}

void check(TradeoffTable& table, int frames_of_scene, ErrorsOnFrames& errors, CheckedChoice& checked) {
  TradeoffRow& row = table.rows.at(checked.choice.row);
  checked.frames = fresh_frames(row, frames_of_scene);
  checked.found_rmse = look_further(row, checked.frames, errors);
}

}  // namespace

TradeoffOptions measuring_for_budget(const std::string& identity) {
  TradeoffOptions options;
  options.identity = identity;
  options.frames = frames_to_choose_by;
  options.pixels = 8000;  // 2000 leave intervals of 12 %: choices were a fifth slower than they had to be
  options.rays = 256;
  options.rounds = 4;
  options.sweeps = 2;
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

ErrorsOnFrames::ErrorsOnFrames(Device& device, World& world, const TradeoffOptions& options)
    : device_(device), world_(world), options_(options) {}
ErrorsOnFrames::~ErrorsOnFrames() = default;

void ErrorsOnFrames::look_at(const std::vector<const TradeoffRow*>& rows, const std::vector<int>& frames) {
  std::vector<const TradeoffRow*> unknown;
  for (const TradeoffRow* row : rows)
    if (!found_.contains({frames, row->name})) unknown.push_back(row);
  if (unknown.empty()) return;
  if (judge_)
    judge_->look_at(frames);
  else
    judge_ =
        std::make_unique<TradeoffJudge>(device_, world_, JudgeOptions{frames, options_.pixels, options_.rays, false});
  for (const TradeoffRow* row : unknown) {
    judge_->choose(row->variant);
    found_[{frames, row->name}] = judge_->view_errors(judge_->values().visibility);
  }
}

const std::vector<ViewError>& ErrorsOnFrames::of(const TradeoffRow& row, const std::vector<int>& frames) {
  look_at({&row}, frames);
  return found_.at({frames, row.name});
}

CheckedChoice choose_within_error(TradeoffTable& table, int frames_of_scene, double max_rmse, ErrorsOnFrames& errors) {
  std::map<std::size_t, int> looks;  // by row
  for (CheckedChoice checked;;) {    // ends: a row is looked at a few times, and promised no less than what was found
    checked.choice = cheapest_within(table, frames_of_scene, max_rmse);
    const std::vector<std::size_t> doubtful = doubtful_rows(table, frames_of_scene, max_rmse, checked.choice.row);
    const auto next = std::find_if(doubtful.begin(), doubtful.end(), [&](std::size_t row) {
      return looks[row] < looks_at_doubtful && !fresh_frames(table.rows[row], frames_of_scene).empty();
    });
    if (next != doubtful.end()) {
      ++looks[*next];
      look_further(table.rows[*next], fresh_frames(table.rows[*next], frames_of_scene), errors);
      continue;
    }
    if (checked.choice.row == no_row) return checked;
    check(table, frames_of_scene, errors, checked);
    if (checked.found_rmse <= max_rmse) return checked;
  }
}

CheckedChoice choose_within_time(TradeoffTable& table, int frames_of_scene, double max_ms, ErrorsOnFrames& errors) {
  CheckedChoice checked;
  checked.choice = most_accurate_within(table, frames_of_scene, max_ms);
  if (checked.choice.row != no_row) check(table, frames_of_scene, errors, checked);
  return checked;
}

}  // namespace understory
