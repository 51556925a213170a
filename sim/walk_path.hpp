// A path seen by the distance walked along it: steps are spaced by distance, not by time.
#pragma once
#include <functional>
#include <vector>

#include "sim/path.hpp"

namespace understory {

class WalkPath {
 public:
  /// `ground_at`: added to the path's height where `source.on_terrain`.
  WalkPath(const OccluderSource& source, std::function<double(glm::dvec2)> ground_at);

  double start() const { return times_.front(); }   // s
  double duration() const { return duration_; }     // s; 0: stands still for ever
  double length() const { return walked_.back(); }  // m, horizontal; of one turn when the path loops
  double top_speed() const { return top_speed_; }   // m/s
  bool loops() const { return loops_; }

  /// Where the body is. On the ground when the source is on terrain.
  Transform at_time(double time) const;
  /// Horizontal distance walked since the start, m.
  double distance_at(double time) const;
  /// Where the body is after `distance`; before the start and past the end straight on, or around again.
  Transform at_distance(double distance) const;
  /// Height of the ground at a place beside the path, where the body's own ground is `body_height`, m.
  double ground_at(glm::dvec2 at, double body_height) const;

 private:
  const std::vector<Keyframe>& keyframes_;
  std::function<double(glm::dvec2)> ground_at_;
  bool loops_, on_terrain_;
  double duration_ = 0, top_speed_ = 0;
  std::vector<double> times_, walked_;  // evenly spaced in time; the distance walked by then
};

}  // namespace understory
