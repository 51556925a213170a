// Which frames a run computes: a half-open range of indices with a stride, written as in Python's slices.
#pragma once
#include <string>

namespace understory {

/// first, first + step, ... below end. Never empty.
struct FrameRange {
  int first = 0, end = 1, step = 1;
  int count() const { return (end - first + step - 1) / step; }
  int at(int position) const { return first + position * step; }
};

/// Indices that files can number: larger ones are taken for typing errors.
inline constexpr int frame_index_limit = 10'000'000;

/// "A:B", "A:B:S", ":B", "A:" or "N" (frame N alone); what is left out comes from the scene: 0, `scene_frames`, 1.
/// Frames past the scene's own count are allowed: every frame is a function of time.
/// Throws Error(usage) for anything else, and for a range without a frame.
FrameRange parse_frame_range(const std::string& text, int scene_frames);

}  // namespace understory
