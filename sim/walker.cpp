// Gait by distance: each foot stands, rolls and swings as a function of the share of a stride; hips, trunk and arms go
// with it; knees follow from where hip and ankle are.
#include "sim/walker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sim/error.hpp"
#include "sim/walk_path.hpp"

namespace understory {
namespace {

// Lengths in m for a body of 1.8 m; others are scaled.
constexpr double drawn_height = 1.8;
constexpr double thigh = 0.441, shank = 0.443, upper_arm = 0.30, forearm = 0.30;
constexpr double sole_below_ankle = 0.07, heel_behind_ankle = 0.07, toe_before_ankle = 0.17;
constexpr double hip_height = 0.905, hip_aside = 0.095, foot_aside = 0.08;
constexpr double shoulder_height = 0.52, shoulder_aside = 0.235;  // above the hips
constexpr double nominal_stride = 1.35;                           // two steps

// Shares of a foot's cycle, which begins when its heel strikes.
constexpr double flat_from = 0.09, heel_rises = 0.36, toe_off = 0.6, below_hip = 0.245;
constexpr double strike_pitch = -0.35, toe_off_pitch = 0.95;  // radians, positive: heel up
constexpr double swing_clearance = 0.025;                     // m
constexpr int keyframes_per_stride = 48;
constexpr double most_strides = 10'000;

double smooth(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

/// From rest to rest with no jolt at either end.
double smoother(double x) { return x * x * x * (x * (6 * x - 15) + 10); }

double turn_of(double share) { return 2 * std::numbers::pi * share; }

/// Ellipses (diameter forward, diameter across, height above the hips) from the seat to the top of the head.
const std::vector<glm::dvec3>& torso_and_head() {
  static const std::vector<glm::dvec3> sections{
      {0.08, 0.12, -0.11},  {0.15, 0.24, -0.095},  {0.19, 0.30, -0.06},  {0.205, 0.325, 0.00}, {0.20, 0.315, 0.06},
      {0.185, 0.285, 0.14}, {0.18, 0.275, 0.20},   {0.195, 0.295, 0.28}, {0.215, 0.33, 0.36},  {0.22, 0.36, 0.44},
      {0.205, 0.37, 0.50},  {0.17, 0.33, 0.545},   {0.13, 0.21, 0.575},  {0.112, 0.12, 0.60},  {0.11, 0.11, 0.64},
      {0.125, 0.115, 0.66}, {0.165, 0.135, 0.685}, {0.19, 0.148, 0.72},  {0.205, 0.155, 0.77}, {0.20, 0.155, 0.81},
      {0.175, 0.138, 0.85}, {0.13, 0.105, 0.875},  {0.07, 0.06, 0.89}};
  return sections;
}

enum Part { torso, left_arm, right_arm = left_arm + 2, left_leg = right_arm + 2, right_leg = left_leg + 3 };

OccluderPart part(const char* name, OccluderPart::Shape shape, glm::dvec3 size) {
  OccluderPart made;
  made.name = name;
  made.shape = shape;
  made.size = size;
  return made;
}

/// In order of `Part`: an arm is upper arm and forearm, a leg is thigh, shank and foot.
std::vector<OccluderPart> rest_parts(double scale) {
  using Shape = OccluderPart::Shape;
  std::vector<OccluderPart> parts{part("torso", Shape::stacked, {})};
  for (const glm::dvec3& section : torso_and_head()) parts[torso].sections.push_back(section * scale);
  for (const auto& [upper, fore] :
       {std::pair{"left_upper_arm", "left_forearm"}, {"right_upper_arm", "right_forearm"}}) {
    parts.push_back(part(upper, Shape::capsule, glm::dvec3(0.10, 0.095, upper_arm + 0.08) * scale));
    parts.push_back(part(fore, Shape::capsule, glm::dvec3(0.08, 0.07, forearm + 0.06) * scale));
  }
  const std::array<std::array<const char*, 3>, 2> legs{
      {{"left_thigh", "left_shank", "left_foot"}, {"right_thigh", "right_shank", "right_foot"}}};
  for (const auto& names : legs) {
    parts.push_back(part(names[0], Shape::capsule, glm::dvec3(0.165, 0.155, thigh + 0.12) * scale));
    parts.push_back(part(names[1], Shape::capsule, glm::dvec3(0.115, 0.11, shank + 0.08) * scale));
    parts.push_back(part(names[2], Shape::box,
                         glm::dvec3(heel_behind_ankle + toe_before_ankle, 0.095, sole_below_ankle + 0.01) * scale));
  }
  return parts;
}

/// Angles of transform_of's fixed axes for a rotation whose forward axis is not vertical.
Keyframe keyframe(double time, const glm::dmat3& axes, glm::dvec3 position) {
  const glm::dvec3 angles(std::atan2(axes[1].z, axes[2].z), std::asin(std::clamp(-axes[0].z, -1.0, 1.0)),
                          std::atan2(axes[0].y, axes[0].x));
  return {time, position, angles};
}

/// A limb's axes: z from `low` to `high`, x as far forward as that allows.
glm::dmat3 axes_along(glm::dvec3 low, glm::dvec3 high, glm::dvec3 forward) {
  const glm::dvec3 z = glm::normalize(high - low), y = glm::normalize(glm::cross(z, forward));
  return {glm::cross(y, z), y, z};
}

/// Where the upper of two bones ends when the lower one ends at `end`, bent towards `ahead`. Out of reach: straight.
glm::dvec3 joint_between(glm::dvec3 start, glm::dvec3 end, double upper, double lower, glm::dvec3 ahead) {
  const glm::dvec3 reach = end - start;
  const double distance = std::min(glm::length(reach), upper + lower);
  const glm::dvec3 along = glm::normalize(reach);
  const glm::dvec3 across = glm::normalize(ahead - glm::dot(ahead, along) * along);
  const double cosine = (upper * upper + distance * distance - lower * lower) / (2 * upper * distance);
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return start + upper * (cosine * along + sine * across);
}

struct Foot {
  glm::dvec3 ankle{0};
  glm::dmat3 axes{1};
};

class Gait {
 public:
  Gait(const WalkPath& path, double scale, int side) : path_(path), scale_(scale), side_(side) {}

  static double stride(const WalkPath& path, double scale) {
    // Steps fit the path: an open one ends as it began, on both feet; a closed one begins again without a jump.
    const double unit = path.loops() ? 1 : 0.5, wanted = path.length() / (nominal_stride * scale * unit);
    return path.length() > 0 ? path.length() / (unit * std::max(1.0, std::round(wanted))) : nominal_stride * scale;
  }

  /// Share of the foot's cycles since the start; both feet stand at the start.
  double cycles(double distance, double stride) const { return distance / stride + (side_ > 0 ? 0.04 : 0.54); }

  Foot foot_at(double distance, double stride) const {
    const double cycle = std::floor(cycles(distance, stride)), share = cycles(distance, stride) - cycle;
    const Plant here = plant(cycle, stride);
    if (share < flat_from) return about_heel(here, strike_pitch * (1 - smooth(share / flat_from)));
    if (share < heel_rises) return about_heel(here, 0);
    const auto risen = [](double at) {
      const double rise = (at - heel_rises) / (toe_off - heel_rises);
      return toe_off_pitch * rise * rise;
    };
    if (share < toe_off) return about_toe(here, risen(share));
    return swing(about_toe(here, toe_off_pitch), about_heel(plant(cycle + 1, stride), strike_pitch), here,
                 plant(cycle + 1, stride), (share - toe_off) / (1 - toe_off));
  }

 private:
  /// A place where the foot stands flat: below the ankle.
  struct Plant {
    glm::dvec3 ground{0};
    glm::dmat3 axes{1};
  };

  Plant plant(double cycle, double stride) const {
    const double distance = (cycle + below_hip - (side_ > 0 ? 0.04 : 0.54)) * stride;
    const Transform body = path_.at_distance(distance);
    const glm::dvec3 forward = body.rotation * glm::dvec3(1, 0, 0);
    const double yaw = std::atan2(forward.y, forward.x);
    Plant found;
    found.axes = {{std::cos(yaw), std::sin(yaw), 0}, {-std::sin(yaw), std::cos(yaw), 0}, {0, 0, 1}};
    found.ground = body.translation + side_ * foot_aside * scale_ * found.axes[1];
    found.ground.z = path_.ground_at(glm::dvec2(found.ground), body.translation.z);
    return found;
  }

  static glm::dmat3 pitched(const glm::dmat3& axes, double pitch) {
    const double c = std::cos(pitch), s = std::sin(pitch);
    return axes * glm::dmat3({c, 0, -s}, {0, 1, 0}, {s, 0, c});
  }

  /// `edge`: of the sole, m before the ankle; it stays on the ground.
  Foot about(const Plant& plant, double edge, double pitch) const {
    Foot foot;
    foot.axes = pitched(plant.axes, pitch);
    const glm::dvec3 pivot = plant.ground + edge * scale_ * plant.axes[0];
    foot.ankle = pivot - foot.axes * glm::dvec3(edge * scale_, 0, -sole_below_ankle * scale_);
    return foot;
  }
  Foot about_heel(const Plant& plant, double pitch) const { return about(plant, -heel_behind_ankle, pitch); }
  Foot about_toe(const Plant& plant, double pitch) const { return about(plant, toe_before_ankle, pitch); }

  /// From toe-off to heel strike: the sole's lower edge clears the line between both places.
  Foot swing(const Foot& from, const Foot& to, const Plant& left, const Plant& next, double share) const {
    const double way = smoother(share), pitch = std::lerp(toe_off_pitch, strike_pitch, smooth(share * 1.15));
    const glm::dvec3 forward = glm::normalize(glm::mix(left.axes[0], next.axes[0], way));
    const glm::dvec3 up(0, 0, 1);
    Foot foot;
    foot.axes = pitched({forward, glm::normalize(glm::cross(up, forward)), up}, pitch);
    foot.ankle = glm::mix(from.ankle, to.ankle, way);
    const double edge = pitch > 0 ? toe_before_ankle : -heel_behind_ankle;
    const double above_sole = -(foot.axes * glm::dvec3(edge, 0, -sole_below_ankle)).z * scale_;
    // Leaves and meets the ground steeply, while the way begins and ends at rest: the toe does not drag.
    const double lift = std::sin(std::numbers::pi * share);
    foot.ankle.z = std::lerp(left.ground.z, next.ground.z, way) + above_sole + swing_clearance * scale_ * lift;
    return foot;
  }

  const WalkPath& path_;
  double scale_;
  int side_;  // 1 left, -1 right
};

class Walker {
 public:
  Walker(const OccluderSource& source, const WalkPath& path)
      : path_(path),
        scale_(source.height / drawn_height),
        stride_(Gait::stride(path, scale_)),
        feet_{Gait(path, scale_, 1), Gait(path, scale_, -1)},
        parts_(rest_parts(scale_)) {}

  std::vector<OccluderPart> take_parts() { return std::move(parts_); }
  double strides() const { return path_.length() / stride_; }
  /// Keyframes that leave no visible error between them at the path's top speed.
  int steps() const {
    return static_cast<int>(std::ceil(path_.duration() * path_.top_speed() / stride_ * keyframes_per_stride));
  }

  void add_keyframes(double time) {
    const double distance = path_.distance_at(time), share = feet_[0].cycles(distance, stride_);
    const Transform body = path_.at_time(time);
    const glm::dmat3 facing = glm::mat3_cast(body.rotation);
    // Highest over the standing foot, and towards it; the trunk turns against the legs.
    const double bob = 0.014 * std::cos(2 * turn_of(share - 0.33)), sway = 0.018 * std::cos(turn_of(share - 0.33));
    const double twist = -0.09 * std::cos(turn_of(share));
    const glm::dvec3 hips = body.translation + facing * glm::dvec3(0, sway, hip_height + bob) * scale_;
    const glm::dmat3 trunk = facing * glm::dmat3(glm::mat3_cast(glm::angleAxis(twist, glm::dvec3(0, 0, 1)) *
                                                                glm::angleAxis(0.04, glm::dvec3(0, 1, 0))));
    parts_[torso].keyframes.push_back(keyframe(time, trunk, hips));
    for (int right = 0; right < 2; ++right) {
      const int side = right ? -1 : 1;
      add_arm(time, right ? right_arm : left_arm, trunk, hips, side, turn_of(share + (right ? 0 : 0.5)));
      add_leg(time, right ? right_leg : left_leg, facing, hips + facing * glm::dvec3(0, side * hip_aside, 0) * scale_,
              feet_[right].foot_at(distance, stride_));
    }
  }

 private:
  void add_bone(double time, int index, glm::dvec3 low, glm::dvec3 high, glm::dvec3 forward) {
    parts_[index].keyframes.push_back(keyframe(time, axes_along(low, high, forward), (low + high) / 2.0));
  }

  /// `phase`: 0 when the leg of the other side strikes; the arm is then foremost.
  void add_arm(double time, int first, const glm::dmat3& trunk, glm::dvec3 hips, int side, double phase) {
    const double swing = 0.05 + 0.38 * std::cos(phase), bend = 0.35 + 0.18 * std::cos(phase - 0.5), aside = 0.06;
    const auto hanging = [&](double angle) {
      return trunk * glm::dvec3(std::sin(angle), side * aside, -std::cos(angle)) / std::sqrt(1 + aside * aside) *
             scale_;
    };
    const glm::dvec3 shoulder = hips + trunk * glm::dvec3(0, side * shoulder_aside, shoulder_height) * scale_;
    const glm::dvec3 elbow = shoulder + upper_arm * hanging(swing), wrist = elbow + forearm * hanging(swing + bend);
    add_bone(time, first, elbow, shoulder, trunk[0]);
    add_bone(time, first + 1, wrist, elbow, trunk[0]);
  }

  void add_leg(double time, int first, const glm::dmat3& facing, glm::dvec3 hip, const Foot& foot) {
    const glm::dvec3 knee = joint_between(hip, foot.ankle, thigh * scale_, shank * scale_, facing[0]);
    add_bone(time, first, knee, hip, facing[0]);
    add_bone(time, first + 1, foot.ankle, knee, facing[0]);
    const glm::dvec3 middle((toe_before_ankle - heel_behind_ankle) / 2, 0, (0.01 - sole_below_ankle) / 2);
    parts_[first + 2].keyframes.push_back(keyframe(time, foot.axes, foot.ankle + foot.axes * middle * scale_));
  }

  const WalkPath& path_;
  double scale_, stride_;
  std::array<Gait, 2> feet_;
  std::vector<OccluderPart> parts_;
};

}  // namespace

OccluderSource make_walker(const OccluderSource& source, const std::function<double(glm::dvec2)>& ground_at) {
  const WalkPath path(source, ground_at);
  Walker walker(source, path);
  if (walker.strides() > most_strides)
    throw Error(
        ErrorKind::invalid_input,
        fmt::format("occluder {}: its path of {:.4g} m takes {:.4g} strides of a walker {:.4g} m high, allowed: "
                    "at most {:g}",
                    source.name, path.length(), walker.strides(), source.height, most_strides));
  const int steps = walker.steps();
  for (int i = 0; i <= steps; ++i) walker.add_keyframes(path.start() + (steps > 0 ? path.duration() * i / steps : 0));
  OccluderSource made = source;
  made.parts = walker.take_parts();
  made.keyframes.clear();
  made.on_terrain = false;
  return made;
}

}  // namespace understory
