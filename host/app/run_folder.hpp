// The output folder of `run`: who may write there, what is finished in it, and how it survives a kill at any moment.
//
// run.json     written at the start (no frames yet) and at the end, each time under a temporary name first
// frames.jsonl one line per finished frame, appended after the frame's files are in place; gone when run.json has it
// all A frame counts as done when its line is there and every file of it still has the recorded SHA-256.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "host/app/run_record.hpp"

namespace understory {

enum class ExistingRun { refuse, resume, replace };

class RunFolder {
 public:
  /// Creates the folder if need be and locks it against other processes. `refuse`: it must be empty. `replace`: the
  /// first write() deletes files that a run could have written and nothing else. `resume`: deletes temporary files of a
  /// killed run and reads what is done; a folder without a run is started afresh.
  /// Throws Error(usage) when it may not be used, Error(input_output) when it cannot.
  RunFolder(const std::filesystem::path& path, ExistingRun existing);
  /// Without a write() a new folder is removed again.
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// The run found at `resume`, with those of its frames whose files verify; none for a new run.
  const std::optional<RunRecord>& earlier() const { return earlier_; }

  /// Writes run.json.
  void write(const RunRecord& record);
  /// Appends to frames.jsonl. Call when the frame's files are in place.
  void add(const FrameRecord& frame);
  /// Writes run.json with all frames and removes frames.jsonl.
  void finish(const RunRecord& record);

 private:
  void read_earlier();
  std::filesystem::path path_;
  int journal_ = -1;  // file descriptor of frames.jsonl, locked
  bool created_ = false, replace_at_first_write_ = false;
  std::optional<RunRecord> earlier_;
};

/// "frame_0007.exr", "visibility_0007.png": stem, index of at least four digits, extension.
std::string frame_file_name(std::string_view stem, int index, std::string_view extension);

}  // namespace understory
