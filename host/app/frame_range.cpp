// Decodes `--frames`.
#include "host/app/frame_range.hpp"

#include <fmt/format.h>

#include <charconv>
#include <string_view>
#include <vector>

#include "sim/error.hpp"

namespace understory {
namespace {

Error bad_range(const std::string& text, const std::string& why) {
  return {ErrorKind::usage,
          fmt::format("--frames {}: {} (allowed: A:B, A:B:S or N, with 0 <= A < B <= {}, S >= 1; B itself is left out)",
                      text, why, frame_index_limit)};
}

int parse_index(std::string_view part, int when_empty, const std::string& whole) {
  if (part.empty()) return when_empty;
  int value = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
  if (error != std::errc{} || end != part.data() + part.size())
    throw bad_range(whole, fmt::format("'{}' is no whole number", part));
  if (value < 0 || value > frame_index_limit) throw bad_range(whole, fmt::format("{} is out of range", value));
  return value;
}

std::vector<std::string_view> split_at_colons(std::string_view text) {
  std::vector<std::string_view> parts;
  for (std::size_t colon; (colon = text.find(':')) != std::string_view::npos; text.remove_prefix(colon + 1))
    parts.push_back(text.substr(0, colon));
  parts.push_back(text);
  return parts;
}

}  // namespace

FrameRange parse_frame_range(const std::string& text, int scene_frames) {
  const auto parts = split_at_colons(text);
  if (text.empty() || parts.size() > 3) throw bad_range(text, "not a range");
  FrameRange range;
  range.first = parse_index(parts[0], 0, text);
  if (parts.size() == 1)
    range.end = range.first + 1;
  else
    range.end = parse_index(parts[1], scene_frames, text);
  if (parts.size() == 3) range.step = parse_index(parts[2], 1, text);
  if (range.step < 1) throw bad_range(text, "the step must be at least 1");
  if (range.end <= range.first) throw bad_range(text, "no frame in this range");
  return range;
}

}  // namespace understory
