// A two-stage pipeline of oneTBB.
#include "host/app/frame_loop.hpp"

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <optional>

namespace understory {
namespace {

constexpr std::size_t frames_held = 3;

std::string message_of_current_exception() {
  try {
    throw;
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "unknown failure";
  }
}

}  // namespace

FrameLoopResult run_frame_loop(const std::vector<int>& indices, const std::function<FrameWriter(int)>& compute,
                               const std::function<int()>& stop_signal) {
  FrameLoopResult result;
  std::size_t next = 0;
  const auto compute_next = [&](tbb::flow_control& control) -> FrameWriter {
    while (next < indices.size() && !(result.signal = stop_signal())) {
      const int index = indices[next++];
      try {
        // Isolated: a thread that waits inside a computation must not take up the writing of another frame.
        return tbb::this_task_arena::isolate([&] { return compute(index); });
      } catch (...) {
        result.failed.push_back({index, message_of_current_exception()});
      }
    }
    control.stop();
    return nullptr;
  };
  const auto write = [](const FrameWriter& writer) {
    if (writer) writer();
  };
  tbb::parallel_pipeline(frames_held,
                         tbb::make_filter<void, FrameWriter>(tbb::filter_mode::serial_in_order, compute_next) &
                             tbb::make_filter<FrameWriter, void>(tbb::filter_mode::serial_in_order, write));
  return result;
}

}  // namespace understory
