// The walker: eleven parts whose joints hold, whose feet neither slide nor sink, on any path and any ground.
#include "sim/walker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "sim/path.hpp"
#include "tests/support/errors.hpp"

namespace understory {
namespace {

using Ground = std::function<double(glm::dvec2)>;
const Ground level = [](glm::dvec2) { return 0.0; };
const Ground slope = [](glm::dvec2 at) { return 0.08 * at.x + 0.15 * std::sin(0.3 * at.y); };

OccluderSource walker_on(std::vector<Keyframe> path, bool loop = false, double height = 1.8) {
  OccluderSource source;
  source.name = "someone";
  source.generator = "walker";
  source.height = height;
  source.keyframes = std::move(path);
  source.loop = loop;
  return source;
}

const std::vector<Keyframe> straight{{0, {-4, 1, 0}, {}}, {2, {-1.4, 1, 0}, {}}, {4, {1.2, 1, 0}, {}}};
/// Sets out, turns by a quarter, stands for a second, walks on.
const std::vector<Keyframe> with_a_rest{{0, {0, 0, 0}, {0, 0, 0}},       {1.5, {2, 0.3, 0}, {0, 0, 0.4}},
                                        {3, {3.2, 1.6, 0}, {0, 0, 1.2}}, {4, {3.3, 1.8, 0}, {0, 0, 1.4}},
                                        {5, {3.3, 1.8, 0}, {0, 0, 1.4}}, {7, {3.3, 4, 0}, {0, 0, 1.57}}};

std::vector<Keyframe> circle() {
  std::vector<Keyframe> path;
  for (int i = 0; i <= 12; ++i) {
    const double angle = i * std::acos(-1.0) / 6;
    path.push_back({i * 0.8, {2 * std::cos(angle), 2 * std::sin(angle), 0}, {0, 0, angle + std::acos(0.0)}});
  }
  return path;
}

struct PosedWalker {
  PosedWalker(const OccluderSource& made, double time) {
    for (const OccluderPart& part : made.parts) {
      size[part.name] = part.size;
      pose[part.name] = path_at(part.keyframes, made.loop, time);
    }
  }
  /// A point of a part, in shares of half its size.
  glm::dvec3 point(const std::string& part, glm::dvec3 share) const {
    return pose.at(part).apply(0.5 * share * size.at(part));
  }
  std::map<std::string, glm::dvec3> size;
  std::map<std::string, Transform> pose;
};

/// Of a foot's sole: height above the ground, and where.
std::array<glm::dvec3, 4> sole(const PosedWalker& walker, const std::string& side) {
  const std::string foot = side + "_foot";
  return {walker.point(foot, {-1, -1, -1}), walker.point(foot, {-1, 1, -1}), walker.point(foot, {1, -1, -1}),
          walker.point(foot, {1, 1, -1})};
}

TEST(Walker, HasElevenPartsOfItsHeight) {
  for (const double height : {0.9, 1.8}) {
    const OccluderSource made = make_walker(walker_on({}, false, height), level);
    ASSERT_EQ(made.parts.size(), static_cast<std::size_t>(walker_parts));
    std::set<std::string> names;
    for (const OccluderPart& part : made.parts) names.insert(part.name);
    EXPECT_EQ(names.size(), made.parts.size());
    const PosedWalker standing(made, 0);
    const double top = standing.pose.at("torso").translation.z + made.parts[0].sections.back().z;
    EXPECT_NEAR(top / height, 1, 0.02);
  }
}

struct Case {
  const char* name;
  OccluderSource source;
  Ground ground;
  double sinks;  // m, how far a sole may be below the ground
};

std::vector<Case> cases() {
  return {
      {"straight", walker_on(straight), level, 0.002},       {"child", walker_on(straight, false, 1.1), level, 0.002},
      {"with a rest", walker_on(with_a_rest), level, 0.002}, {"circle", walker_on(circle(), true), level, 0.002},
      {"slope", walker_on(straight), slope, 0.02},           {"slope and rest", walker_on(with_a_rest), slope, 0.03}};
}

TEST(Walker, FeetNeitherSlideNorSink) {
  for (const Case& tested : cases()) {
    SCOPED_TRACE(tested.name);
    const OccluderSource made = make_walker(tested.source, tested.ground);
    const double end = tested.source.keyframes.back().time, step = 1.0 / 240;
    double deepest = 0, fastest = 0, highest = 0;
    for (double time = 0; time + step < end; time += step) {
      const PosedWalker now(made, time), then(made, time + step);
      double lowest = 1;
      for (const char* side : {"left", "right"}) {
        const auto corners = sole(now, side), later = sole(then, side);
        for (std::size_t c = 0; c < corners.size(); ++c) {
          const double above = corners[c].z - tested.ground(glm::dvec2(corners[c]));
          const double above_later = later[c].z - tested.ground(glm::dvec2(later[c]));
          lowest = std::min(lowest, above);
          if (std::max(above, above_later) < 0.0005 + tested.sinks - 0.002)
            fastest = std::max(fastest, glm::distance(glm::dvec2(corners[c]), glm::dvec2(later[c])) / step);
        }
      }
      deepest = std::max(deepest, -lowest);
      highest = std::max(highest, lowest);
    }
    EXPECT_LT(deepest, tested.sinks);
    EXPECT_LT(highest, tested.sinks);  // one foot is always on the ground
    if (tested.sinks < 0.01) {
      EXPECT_LT(fastest, 0.15) << "m/s; the body moves at 1.3";
    }
  }
}

TEST(Walker, JointsHold) {
  for (const Case& tested : cases()) {
    SCOPED_TRACE(tested.name);
    const OccluderSource made = make_walker(tested.source, tested.ground);
    const double scale = tested.source.height / 1.8;
    double widest = 0;
    for (double time = 0; time < tested.source.keyframes.back().time; time += 0.0173) {
      const PosedWalker now(made, time);
      for (const std::string side : {"left", "right"}) {
        const auto end = [&](const std::string& part, double bone, double sign) {
          return now.pose.at(side + part).apply({0, 0, sign * bone * scale / 2});
        };
        const glm::dvec3 ankle = now.pose.at(side + "_foot").apply(glm::dvec3(-0.05, 0, 0.03) * scale);
        widest = std::max({widest, glm::distance(end("_thigh", 0.441, -1), end("_shank", 0.443, 1)),
                           glm::distance(end("_shank", 0.443, -1), ankle),
                           glm::distance(end("_upper_arm", 0.3, -1), end("_forearm", 0.3, 1))});
      }
    }
    EXPECT_LT(widest, 0.02 * scale);
  }
}

TEST(Walker, KneesBendForwardsAndElbowsToo) {
  const OccluderSource made = make_walker(walker_on(straight), level);
  for (double time = 0.1; time < 3.9; time += 0.031) {
    const PosedWalker now(made, time);
    for (const std::string side : {"left", "right"}) {
      const double thigh =
          now.pose.at(side + "_thigh").apply({0, 0, -1}).x - now.pose.at(side + "_thigh").translation.x;
      const double shank =
          now.pose.at(side + "_shank").apply({0, 0, -1}).x - now.pose.at(side + "_shank").translation.x;
      EXPECT_GT(thigh - shank, -1e-3) << time;
    }
  }
}

TEST(Walker, ALoopClosesAndAPathEndsOnBothFeet) {
  const OccluderSource made = make_walker(walker_on(circle(), true), level);
  for (const OccluderPart& part : made.parts) {
    const Transform before = path_at(part.keyframes, true, 9.6 - 1e-4),
                    after = path_at(part.keyframes, true, 9.6 + 1e-4);
    EXPECT_LT(glm::distance(before.translation, after.translation), 2e-3) << part.name;
  }
  const PosedWalker end(make_walker(walker_on(straight), level), 4);
  for (const char* side : {"left", "right"}) {
    const auto corners = sole(end, side);
    EXPECT_LT(std::min({corners[0].z, corners[2].z}), 0.002) << side;
  }
}

TEST(Walker, RefusesAnEndlessPath) {
  const std::string message = message_of(ErrorKind::invalid_input, [] {
    make_walker(walker_on({{0, {0, 0, 0}, {}}, {1, {1e6, 0, 0}, {}}}), level);
  });
  EXPECT_NE(message.find("occluder someone"), std::string::npos) << message;
  EXPECT_NE(message.find("at most 10000"), std::string::npos) << message;
}

}  // namespace
}  // namespace understory
