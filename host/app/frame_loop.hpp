// Computes frames one after the other while the one before is being written.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "host/app/run_record.hpp"

namespace understory {

/// A computed frame on its way to the disk; calling it writes the files.
using FrameWriter = std::function<void()>;

struct FrameLoopResult {
  std::vector<FailedFrame> failed;  // frames whose computation threw
  int signal = 0;                   // that ended the loop early; 0: ran to its end
};

/// For each index in order: `compute(index)`, then its writer, which overlaps with the next computation; at most three
/// frames are held. A computation that throws is noted and the loop goes on; a writer that throws ends the loop, and so
/// does `stop_signal()` when it is not 0, after everything computed has been written.
FrameLoopResult run_frame_loop(const std::vector<int>& indices, const std::function<FrameWriter(int)>& compute,
                               const std::function<int()>& stop_signal);

}  // namespace understory
