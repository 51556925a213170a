// Paths pass through their keyframes without a jolt; recorded motion is what the record says.
#include "sim/path.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "sim/motion_record.hpp"
#include "tests/support/data.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/temporary_file.hpp"

namespace understory {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double pi = std::numbers::pi;

double turn_between(const Transform& a, const Transform& b) {
  const glm::dquat turn = glm::conjugate(a.rotation) * b.rotation;
  return 2 * std::atan2(glm::length(glm::dvec3(turn.x, turn.y, turn.z)), std::abs(turn.w));
}

struct Motion {
  glm::dvec3 linear, angular;  // m/s, rad/s
};

/// Mean velocities between two instants, by differences.
Motion motion(const std::vector<Keyframe>& keyframes, bool loop, double from, double to) {
  const Transform a = path_at(keyframes, loop, from), b = path_at(keyframes, loop, to);
  glm::dquat turn = b.rotation * glm::conjugate(a.rotation);
  if (turn.w < 0) turn = -turn;
  return {(b.translation - a.translation) / (to - from), 2.0 * glm::dvec3(turn.x, turn.y, turn.z) / (to - from)};
}

std::vector<Keyframe> wander() {
  return {{1, {0, 0, 0}, {0, 0, 0}},
          {1.5, {2, 1, 0}, {0.3, 0.1, 1.2}},
          {4, {3, 5, 1}, {0.1, -0.6, 2.9}},
          {4.25, {2, 5.5, 1}, {0, -0.5, 3.6}},
          {7, {-4, 0, 0.5}, {0.4, 0, 5}}};
}

void expect_smooth(const std::vector<Keyframe>& keyframes, bool loop, double from, double to) {
  const double step = 1e-5;
  for (double time = from; time < to; time += 0.0625) {  // hits every keyframe time of `wander`
    const Motion before = motion(keyframes, loop, time - step, time),
                 after = motion(keyframes, loop, time, time + step);
    EXPECT_LT(glm::length(after.linear - before.linear), 0.01) << "at " << time;
    EXPECT_LT(glm::length(after.angular - before.angular), 0.01) << "at " << time;
    EXPECT_NEAR(glm::length(path_at(keyframes, loop, time).rotation), 1, 1e-12);
  }
}

TEST(Path, WithoutMotionIsFixed) {
  EXPECT_EQ(path_at({}, false, 3).translation, glm::dvec3(0));
  const std::vector<Keyframe> one{{2, {1, 2, 3}, {0, 0, pi / 2}}};
  for (bool loop : {false, true})
    for (double time : {-10.0, 2.0, 50.0})
      EXPECT_LT(glm::distance(path_at(one, loop, time).apply({1, 0, 0}), glm::dvec3(1, 3, 3)), 1e-12);
}

TEST(Path, TurnsAboutXThenYThenZ) {
  const Transform pose = transform_of({0, {0, 0, 0}, {pi / 2, pi / 2, 0}});
  EXPECT_LT(glm::distance(pose.apply({0, 1, 0}), glm::dvec3(1, 0, 0)), 1e-12);  // y -> z -> x
}

TEST(Path, PassesThroughEveryKeyframe) {
  const std::vector<Keyframe> keyframes = wander();
  for (bool loop : {false, true})
    for (const Keyframe& keyframe : keyframes) {
      const Transform pose = path_at(keyframes, loop, keyframe.time);
      EXPECT_LT(glm::distance(pose.translation, keyframe.position), 1e-9);
      EXPECT_LT(turn_between(pose, transform_of(keyframe)), 1e-7);
    }
}

TEST(Path, HasContinuousVelocities) {
  expect_smooth(wander(), false, 0.5, 8);
  expect_smooth(wander(), true, -2, 20);
}

TEST(Path, RestsBeforeAndAfter) {
  const std::vector<Keyframe> keyframes = wander();
  EXPECT_EQ(path_at(keyframes, false, -1e9).translation, keyframes.front().position);
  EXPECT_EQ(path_at(keyframes, false, 1e9).translation, keyframes.back().position);
}

TEST(Path, KeepsAStraightLineStraightAndAnEvenPaceEven) {
  std::vector<Keyframe> keyframes;
  for (double time : {0.0, 1.0, 1.5, 4.0, 5.0, 6.0})
    keyframes.push_back({time, {2 * time, -time, 0}, {0, 0, 0.7 * time}});
  for (double time = 1; time <= 5; time += 0.1) {  // between the second and the last but one
    const Transform pose = path_at(keyframes, false, time);
    EXPECT_LT(glm::distance(pose.translation, glm::dvec3(2 * time, -time, 0)), 1e-9);
    EXPECT_LT(turn_between(pose, transform_of({0, {}, {0, 0, 0.7 * time}})), 1e-7);
  }
}

TEST(Path, LoopsAcrossARepeatedFirstKeyframe) {
  std::vector<Keyframe> circle;
  for (int i = 0; i <= 8; ++i) {
    const double angle = i * pi / 4;
    circle.push_back({2.0 * i, {10 * std::cos(angle), 10 * std::sin(angle), 0}, {0, 0, angle}});
  }
  expect_smooth(circle, true, -3, 20);
  for (double time = -16; time < 32; time += 0.37) {
    const Transform pose = path_at(circle, true, time);
    EXPECT_NEAR(glm::length(pose.translation), 10, 0.1);
    EXPECT_LT(glm::distance(pose.translation, path_at(circle, true, time + 16).translation), 1e-9);
    EXPECT_LT(turn_between(pose, transform_of({0, {}, {0, 0, time * pi / 8}})), 0.01);
  }
}

TEST(Path, LeadsBackWhereALoopIsOpen) {
  const std::vector<Keyframe> keyframes{{0, {0, 0, 0}, {}}, {1, {4, 0, 0}, {0, 0, 1}}, {2, {4, 4, 0}, {0, 0, 2}}};
  for (double turn : {-3.0, 0.0, 6.0})
    for (const Keyframe& keyframe : keyframes)
      EXPECT_LT(glm::distance(path_at(keyframes, true, keyframe.time + turn).translation, keyframe.position), 1e-9);
  expect_smooth(keyframes, true, -4, 4);
}

TEST(Path, RejectsTimesThatDoNotIncrease) {
  const std::vector<Keyframe> keyframes{{0, {}, {}}, {2, {}, {}}, {2, {1, 0, 0}, {}}};
  EXPECT_THAT(message_of(ErrorKind::invalid_input, [&] { path_at(keyframes, false, 1); }),
              AllOf(HasSubstr("keyframes[2].time"), HasSubstr("2 s")));
}

constexpr const char* header = "time_s,part,m00,m01,m02,m03,m10,m11,m12,m13,m20,m21,m22,m23\n";

TEST(MotionRecord, TurnsYUpIntoZUp) {
  // A quarter turn about the file's y axis (up) takes its x to -z; then one metre up.
  const TemporaryFile file("motion.csv", fmt::format("{}0,arm,0,0,1,0,0,1,0,1,-1,0,0,0\n", header));
  const Transform pose = read_motion_record(file.path(), UpAxis::y).at("arm", 7);
  EXPECT_LT(glm::distance(pose.apply({1, 0, 0}), glm::dvec3(0, 1, 1)), 1e-7);  // -z becomes +y
  EXPECT_LT(glm::distance(pose.apply({0, 0, 2}), glm::dvec3(0, 0, 3)), 1e-7);
  const Transform same_axes = read_motion_record(file.path(), UpAxis::z).at("arm", 7);
  EXPECT_LT(glm::distance(same_axes.apply({1, 0, 0}), glm::dvec3(0, 1, -1)), 1e-7);
}

TEST(MotionRecord, OfOneInstantStandsStill) {
  const TemporaryFile file("motion.csv", fmt::format("{}0.5,arm,1,0,0,2,0,1,0,3,0,0,1,4\n", header));
  const MotionRecord record = read_motion_record(file.path(), UpAxis::z);
  for (double time : {-1.0, 0.0, 0.5, 7.0}) {
    const glm::dvec3 place = record.at("arm", time).translation;
    EXPECT_EQ(place, glm::dvec3(2, 3, 4)) << time;
  }
}

TEST(MotionRecord, InterpolatesAndKeepsItsPartsTogether) {
  const TemporaryFile file("motion.csv", std::string(header) +
                                             "0,slide,1,0,0,0,0,1,0,0,0,0,1,0\n"
                                             "0,still,1,0,0,5,0,1,0,0,0,0,1,0\n"
                                             "1,slide,0,-1,0,2,1,0,0,0,0,0,1,0\n"
                                             "1,still,1,0,0,5,0,1,0,0,0,0,1,0\n");
  const MotionRecord record = read_motion_record(file.path(), UpAxis::z);
  const Transform half = record.at("slide", 0.5);
  EXPECT_NEAR(half.translation.x, 1, 1e-12);
  EXPECT_LT(glm::distance(half.rotation * glm::dvec3(1, 0, 0), glm::dvec3(std::sqrt(0.5), std::sqrt(0.5), 0)), 1e-7);
  EXPECT_EQ(record.period, 2);  // one more step leads back
  EXPECT_NEAR(record.at("slide", 1.5).translation.x, 1, 1e-12);
  for (double time : {-3.7, 0.25, 1.9})
    EXPECT_NEAR(record.at("slide", time).translation.x, record.at("slide", time + 2).translation.x, 1e-9);
  EXPECT_EQ(record.at("still", 1.7).translation, glm::dvec3(5, 0, 0));
  EXPECT_THAT(message_of(ErrorKind::invalid_input, [&] { record.at("wing", 0); }),
              AllOf(HasSubstr("'wing'"), HasSubstr("slide, still")));
}

TEST(MotionRecord, SaysWhatIsWrong) {
  const auto message = [](const std::string& rows) {
    const TemporaryFile file("motion.csv", header + rows);
    return message_of(ErrorKind::invalid_input, [&] { read_motion_record(file.path(), UpAxis::y); });
  };
  EXPECT_THAT(message("0,a,1,0,0,0,0,1,0,0,0,0,1,0\n1,a,2,0,0,0,0,2,0,0,0,0,2,0\n"),
              AllOf(HasSubstr("motion.csv:3"), HasSubstr("not orthonormal"), HasSubstr("a rotation")));
  EXPECT_THAT(message("0,a,-1,0,0,0,0,1,0,0,0,0,1,0\n"), HasSubstr("a mirror image"));
  EXPECT_THAT(message("0,a,1,0,0,0,0,1,0,0,0,0,1,0\n0,a,1,0,0,0,0,1,0,0,0,0,1,0\n"),
              AllOf(HasSubstr("motion.csv:3"), HasSubstr("time_s")));
  EXPECT_THAT(message("0,a,1,0,0,0,0,1,0,0,0,0,1,up\n"), AllOf(HasSubstr("m23"), HasSubstr("'up'")));
}

TEST(MotionRecord, OfTheMilkTruckRollsItsWheels) {
  UNDERSTORY_NEEDS_DATA();
  const MotionRecord record = read_motion_record(data_folder() / "milk_truck/milk_truck_motion.csv", UpAxis::y);
  ASSERT_EQ(record.tracks.size(), 3u);
  EXPECT_EQ(record.find("body")->times.size(), 31u);
  EXPECT_NEAR(record.period, 1.25 * 31 / 30, 1e-9);
  const glm::dvec3 axle(0, 1, 0);  // sideways: the file's z becomes -y
  double least = 1, most = 0;
  for (double time = 0; time < 2 * record.period; time += 0.02) {
    EXPECT_LT(turn_between(record.at("body", time), Transform()), 1e-6);
    const Transform wheel = record.at("wheels_front", time), later = record.at("wheels_front", time + 0.02);
    EXPECT_NEAR(std::abs((wheel.rotation * axle).y), 1, 1e-6);
    EXPECT_NEAR(wheel.translation.x, 1.43267, 1e-5);
    EXPECT_NEAR(wheel.translation.z, 0.427722, 1e-5);
    least = std::min(least, turn_between(wheel, later));
    most = std::max(most, turn_between(wheel, later));
  }
  EXPECT_NEAR(least, most, 0.02);  // an even pace, also across the end of the record
  EXPECT_NEAR(most, 2 * pi * 0.02 / record.period, 0.02);
}

}  // namespace
}  // namespace understory
