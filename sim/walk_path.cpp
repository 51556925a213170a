#include "sim/walk_path.hpp"

#include <algorithm>
#include <cmath>

namespace understory {
namespace {

constexpr int samples_per_segment = 64;  // of the distance walked between two keyframes

}  // namespace

WalkPath::WalkPath(const OccluderSource& source, std::function<double(glm::dvec2)> ground_at)
    : keyframes_(source.keyframes),
      ground_at_(std::move(ground_at)),
      loops_(source.loop && source.keyframes.size() > 1),
      on_terrain_(source.on_terrain),
      duration_(path_duration(source.keyframes, source.loop)) {
  const std::size_t samples = duration_ > 0 ? samples_per_segment * keyframes_.size() : 0;
  const double first = keyframes_.empty() ? 0 : keyframes_.front().time;
  times_.push_back(first);
  walked_.push_back(0);
  glm::dvec2 before(at_time(first).translation);
  for (std::size_t i = 1; i <= samples; ++i) {
    times_.push_back(first + duration_ * static_cast<double>(i) / static_cast<double>(samples));
    const glm::dvec2 here(path_at(keyframes_, loops_, times_.back()).translation);
    const double step = glm::distance(before, here);
    top_speed_ = std::max(top_speed_, step / (times_[i] - times_[i - 1]));
    walked_.push_back(walked_.back() + step);
    before = here;
  }
}

Transform WalkPath::at_time(double time) const {
  Transform body = path_at(keyframes_, loops_, time);
  if (on_terrain_) body.translation.z += ground_at_(glm::dvec2(body.translation));
  return body;
}

double WalkPath::distance_at(double time) const {
  if (duration_ <= 0) return 0;
  const double place =
      std::clamp((time - times_.front()) / duration_, 0.0, 1.0) * static_cast<double>(times_.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(place), times_.size() - 2);
  return std::lerp(walked_[i], walked_[i + 1], place - static_cast<double>(i));
}

Transform WalkPath::at_distance(double distance) const {
  if (loops_ && length() > 0) distance -= std::floor(distance / length()) * length();
  const double on_path = std::clamp(distance, 0.0, length());
  const auto after = std::lower_bound(walked_.begin(), walked_.end(), on_path);
  const auto i = static_cast<std::size_t>(after - walked_.begin());
  double time = times_[i];
  if (i > 0) {
    const double share = (on_path - walked_[i - 1]) / (walked_[i] - walked_[i - 1]);
    time = std::lerp(times_[i - 1], times_[i], share);
  }
  Transform body = at_time(time);
  const glm::dvec3 beyond = body.rotation * glm::dvec3(distance - on_path, 0, 0);
  const double height = body.translation.z;
  body.translation += beyond;
  body.translation.z = ground_at(glm::dvec2(body.translation), height);
  return body;
}

double WalkPath::ground_at(glm::dvec2 at, double body_height) const {
  return on_terrain_ ? ground_at_(at) : body_height;
}

}  // namespace understory
