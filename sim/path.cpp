// Cubic curves through keyframes: velocities at the keyframes from their neighbours, then each segment by itself.
#include "sim/path.hpp"

#include <fmt/format.h>

#include <cmath>

#include "sim/error.hpp"
#include "sim/rotation.hpp"

namespace understory {
namespace {

/// Keyframes seen as a sequence without end: index -1 or n is the neighbour across the seam of a loop, in unwrapped
/// time.
class Knots {
 public:
  Knots(const std::vector<Keyframe>& keyframes, bool loop) : keyframes_(keyframes), loop_(loop) {
    const std::size_t count = keyframes.size();
    for (std::size_t i = 1; i < count; ++i)
      if (!(keyframes[i].time > keyframes[i - 1].time))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("keyframes[{}].time: {:.6g} s, allowed: after that of the keyframe before, {:.6g} s", i,
                                keyframes[i].time, keyframes[i - 1].time));
    const double span = keyframes.back().time - keyframes.front().time;
    const bool closed = same_pose(transform_of(keyframes.front()), transform_of(keyframes.back()));
    distinct_ = static_cast<int>(count) - (loop && closed ? 1 : 0);
    period_ = closed ? span : span * static_cast<double>(count) / static_cast<double>(count - 1);
  }

  bool loop() const { return loop_; }
  int last() const { return static_cast<int>(keyframes_.size()) - 1; }
  double period() const { return period_; }

  double time(int i) const {
    const int turn = turns(i);
    return keyframes_[index(i, turn)].time + turn * period_;
  }
  Transform pose(int i) const { return transform_of(keyframes_[index(i, turns(i))]); }

 private:
  int turns(int i) const { return loop_ ? (i >= 0 ? i / distinct_ : (i + 1) / distinct_ - 1) : 0; }
  std::size_t index(int i, int turn) const { return static_cast<std::size_t>(i - turn * distinct_); }

  const std::vector<Keyframe>& keyframes_;
  bool loop_;
  int distinct_ = 0;   // keyframes of one turn
  double period_ = 0;  // s
};

struct Velocity {
  glm::dvec3 linear{0};   // m/s
  glm::dvec3 angular{0};  // rad/s, in the body's own axes
};

Velocity mean_velocity(const Knots& knots, int from) {
  const Transform a = knots.pose(from), b = knots.pose(from + 1);
  const double step = knots.time(from + 1) - knots.time(from);
  return {(b.translation - a.translation) / step, rotation_vector(glm::conjugate(a.rotation) * b.rotation) / step};
}

/// Slope at a knot of the parabola through it and its neighbours; at rest at the ends of an open path.
Velocity velocity_at(const Knots& knots, int i) {
  if (!knots.loop() && (i == 0 || i == knots.last())) return {};
  const double before = knots.time(i) - knots.time(i - 1), after = knots.time(i + 1) - knots.time(i);
  const double share = before / (before + after);
  const Velocity in = mean_velocity(knots, i - 1), out = mean_velocity(knots, i);
  return {glm::mix(in.linear, out.linear, share), glm::mix(in.angular, out.angular, share)};
}

/// Cubic Bezier curves with the given velocities at both ends: in space, and over unit quaternions by cumulative basis
/// (Kim, Kim, Shin 1995, "A general construction scheme for unit quaternion curves", eqs. 4-6).
Transform on_segment(const Knots& knots, int i, double time) {
  const double step = knots.time(i + 1) - knots.time(i), u = (time - knots.time(i)) / step, v = 1 - u;
  const Transform a = knots.pose(i), b = knots.pose(i + 1);
  const Velocity start = velocity_at(knots, i), end = velocity_at(knots, i + 1);

  const glm::dvec3 control_a = a.translation + start.linear * (step / 3);
  const glm::dvec3 control_b = b.translation - end.linear * (step / 3);
  const double basis_0 = v * v * v, basis_1 = 3 * u * v * v, basis_2 = 3 * u * u * v, basis_3 = u * u * u;

  const glm::dvec3 first = start.angular * (step / 3), third = end.angular * (step / 3);
  const glm::dvec3 second =
      rotation_vector(rotation_of(-first) * glm::conjugate(a.rotation) * b.rotation * rotation_of(-third));
  const glm::dquat rotation = a.rotation * rotation_of(first * (1 - basis_0)) *
                              rotation_of(second * (basis_2 + basis_3)) * rotation_of(third * basis_3);
  return {glm::normalize(rotation),
          basis_0 * a.translation + basis_1 * control_a + basis_2 * control_b + basis_3 * b.translation};
}

}  // namespace

Transform transform_of(const Keyframe& keyframe) {
  const glm::dquat x = glm::angleAxis(keyframe.rotation.x, glm::dvec3(1, 0, 0));
  const glm::dquat y = glm::angleAxis(keyframe.rotation.y, glm::dvec3(0, 1, 0));
  const glm::dquat z = glm::angleAxis(keyframe.rotation.z, glm::dvec3(0, 0, 1));
  return {z * y * x, keyframe.position};
}

double path_duration(const std::vector<Keyframe>& keyframes, bool loop) {
  if (keyframes.size() < 2) return 0;
  return loop ? Knots(keyframes, loop).period() : keyframes.back().time - keyframes.front().time;
}

Transform path_at(const std::vector<Keyframe>& keyframes, bool loop, double time) {
  if (keyframes.empty()) return {};
  if (keyframes.size() == 1) return transform_of(keyframes.front());
  const Knots knots(keyframes, loop);
  if (loop) {
    const double since = time - knots.time(0);
    time = knots.time(0) + since - std::floor(since / knots.period()) * knots.period();
  } else {
    if (time <= keyframes.front().time) return transform_of(keyframes.front());
    if (time >= keyframes.back().time) return transform_of(keyframes.back());
  }
  int segment = 0;
  while (segment < knots.last() && time >= knots.time(segment + 1)) ++segment;
  return on_segment(knots, segment, time);
}

}  // namespace understory
