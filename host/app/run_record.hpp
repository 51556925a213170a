// What `run.json` holds: enough to repeat a run, to check its files and to go on after a kill.
// Everything but what is measured (`ms`, `passes`, `peak_rss_mib`, the device's memory and threads) is the same for a
// run that was interrupted and resumed as for one that was not.
#pragma once
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace understory {

struct FrameRecord {
  int index = 0;
  double time_s = 0;
  double ms = 0;                                    // wall time of posing, drawing and shading the frame
  std::map<std::string, double> passes;             // device time by pass name, ms
  std::map<std::string, std::string> files;         // name inside the folder -> SHA-256
  std::string sha256;                               // of the frame's main file: EXR, else PNG, else VTK, else PLY
  std::map<std::uint32_t, std::uint64_t> validity;  // code (a single bit) -> pixels that carry it
  std::string chosen;                               // methods of a frame of an adaptive run; empty: the run's
};

struct FailedFrame {
  int index = 0;
  std::string message;
};

/// What --max-error or --max-ms chose before the run, what that promised, and what was found on other frames. Errors
/// are upper ends of 95 % intervals of the RMSE of V in a frame (bench/budget.hpp).
struct BudgetRecord {
  double max_error = 0, max_ms = 0;  // what was asked for; the other is 0
  std::string choice;                // methods, in words
  double promised_rmse = 0, promised_ms = 0;
  std::vector<int> chosen_by, checked_on;  // frames; none to check on: the scene has no more
  double found_rmse = 0;                   // in the worst of `checked_on`
};

struct RunRecord {
  /// What decides the bytes of the files. A run is resumed only when these are unchanged.
  std::string version;
  std::string program_sha256;                 // of the executable: another build may round differently
  std::string scene_sha256;                   // of the resolved scene, overrides applied
  std::map<std::string, std::string> inputs;  // files the scene names -> SHA-256
  std::string device;                         // the device's description as JSON text; empty: not chosen yet
  int width = 0, height = 0, supersample = 1;
  std::vector<std::string> dumps;  // exr, png, vtk, ply

  std::string scene;  // file as given
  std::uint64_t seed = 0;
  std::map<std::string, std::string> methods;
  std::optional<BudgetRecord> budget;  // methods were chosen, not asked for
  std::vector<std::string> plan, programs;
  double peak_rss_mib = 0;
  std::map<int, FrameRecord> frames;
  std::vector<FailedFrame> failed;
  bool complete = false;  // every frame asked for is there
};

/// Keys whose values differ, with both values, one line each: what keeps `now` from going on with `earlier`.
std::vector<std::string> differences(const RunRecord& earlier, const RunRecord& now);

/// Whether the methods may change from frame to frame: then frames are not a function of (scene, seed, time) alone.
bool is_adaptive(const RunRecord& record);

std::string to_json_text(const RunRecord& record);
std::string to_json_line(const FrameRecord& frame);

/// `where` names the file in messages. Throws Error(invalid_input) for text that is no record.
RunRecord parse_run_record(const std::string& text, const std::string& where);
FrameRecord parse_frame_record(const std::string& line, const std::string& where);

}  // namespace understory
