// pose_grass against sim's wind in double and a blade that is integrated along its length; blades keep their length and
// their root whatever the wind does.
#include <gtest/gtest.h>

#include <cmath>

#include "host/frame/geometry.hpp"
#include "host/passes/pose_grass.hpp"
#include "sim/grass_wind.hpp"
#include "sim/random.hpp"
#include "tests/reference/pose_grass.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/pose_on_device.hpp"

namespace understory {
namespace {

constexpr glm::dvec3 eye(3, -4, 1.7);

GrassBlades random_blades(std::size_t count) {
  Random random(31, 4, count);
  GrassBlades blades;
  for (std::size_t i = 0; i < count; ++i) {
    const auto add = [&](std::vector<float>& plane, double low, double high) {
      plane.push_back(static_cast<float>(random.uniform(low, high)));
    };
    add(blades.root_x, -20, 20);
    add(blades.root_y, -20, 20);
    add(blades.root_z, -1, 1);
    add(blades.length, 0.1, 1.2);
    add(blades.half_width, 0.002, 0.01);
    add(blades.bend_x, -1, 1);
    add(blades.bend_y, -1, 1);
    add(blades.facing, 0, 6.283);
    add(blades.flexibility, 0.5, 2);
    add(blades.phase, 0, 6.283);
  }
  return blades;
}

/// A series without gusts: all samples are at the mean.
ModalSeries calm(double mean) {
  ModalSeries series;
  series.mean = mean;
  series.along = series.across = std::vector<float>(64, 0.0f);
  return series;
}

struct WindyField {
  GrassBlades blades;
  ModalSeries response;
  GrassWind wind{};
};

WindyField field_in(const WindSource& source, std::size_t count, double time) {
  const Wind wind(source, 5);
  const GrassField field;
  WindyField windy{random_blades(count), grass_response(wind, field), {}};
  windy.wind = grass_wind_at(wind, field, windy.response, time, eye);
  return windy;
}

WindyField field_in_steady_wind(double mean, std::size_t count) {
  WindyField windy{random_blades(count), calm(mean), {}};
  windy.wind = grass_wind_at(Wind(WindSource{}, 5), GrassField{}, windy.response, 0, eye);
  windy.wind.flutter_amplitude = 0;
  return windy;
}

/// All vertices of `field` posed at `lanes` blades per work-item (0: by the pass, at the device's width); vertex k of
/// blade i is at(k * 256 ..) of its group, as kernels/pose_grass.cl lays them out. Another field lies before it.
struct PosedField {
  Points points;
  std::size_t first_vertex = 0;
  glm::dvec3 vertex(std::size_t blade, std::size_t k) const {
    return points.at(first_vertex + blade / 256 * 7 * 256 + k * 256 + blade % 256);
  }
  glm::dvec3 midline(std::size_t blade, std::size_t pair) const {
    return pair == 3 ? vertex(blade, 6) : 0.5 * (vertex(blade, 2 * pair) + vertex(blade, 2 * pair + 1));
  }
};

PosedField pose(Device& device, const WindyField& field, int lanes) {
  World world;
  world.grass = {random_blades(300), field.blades};
  Geometry geometry = upload_geometry(device, world);
  geometry.posed.points.write(std::vector(geometry.vertices, untouched_point));
  std::vector<std::array<float, 2>> pairs;
  for (const glm::vec2 pair : interleaved(field.response)) pairs.push_back({pair.x, pair.y});
  const SwaySeries series = upload_test_data(device, pairs);
  const FieldRange& range = geometry.fields[1];
  if (lanes == 0)
    PoseGrassPass(device).run(geometry.blades, field.wind, series, range.first_blade, range.blades, range.first_vertex,
                              geometry.posed);
  else
    pose_grass_on(device, lanes, geometry.blades, field.wind, series, range.first_blade, range.blades,
                  range.first_vertex, geometry.posed);
  PosedField posed{read_points(geometry.posed), range.first_vertex};
  EXPECT_EQ(std::vector<float>(posed.points.x.begin(), posed.points.x.begin() + range.first_vertex),
            std::vector<float>(range.first_vertex, untouched))
      << "wrote into the field before";
  return posed;
}

std::array<glm::dvec3, 7> expected_blade(const WindyField& field, std::size_t i) {
  const GrassBlades& b = field.blades;
  const glm::dvec2 bend =
      grass_bend(field.wind, field.response,
                 {{b.root_x[i], b.root_y[i]}, {b.bend_x[i], b.bend_y[i]}, b.flexibility[i], b.phase[i]});
  return reference::posed_blade(glm::dvec3(b.root_x[i], b.root_y[i], b.root_z[i]) - eye, b.length[i], b.half_width[i],
                                b.facing[i], bend);
}

class PoseGrass : public testing::TestWithParam<int> {
 protected:
  int lanes() const { return GetParam(); }
};
INSTANTIATE_TEST_SUITE_P(Width, PoseGrass, testing::ValuesIn(vector_widths));

/// Roots 25 m from the eye have a float raster of 1e-6 m; arc.h errs by 1e-6 of a length of 1.2 m.
constexpr double steady_error = 5e-6;  // m
/// In gusts also the place in the series is a float: 1/256 sample of 65536, times its steepest slope and the length.
constexpr double gust_error = 2e-4;  // m

TEST_P(PoseGrass, AgreesWithTheReferenceInSteadyWind) {
  for (const DeviceInfo& info : list_devices()) {
    Device device(std::to_string(info.index));
    for (std::size_t count : {1, 255, 257}) {
      const WindyField field = field_in_steady_wind(0.6, count);
      const PosedField posed = pose(device, field, lanes());
      for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < 7; ++k)
          ASSERT_LT(glm::distance(posed.vertex(i, k), expected_blade(field, i)[k]), steady_error)
              << "vertex " << k << " of blade " << i << " of " << count << " on " << info.name;
    }
  }
}

TEST_P(PoseGrass, AgreesWithTheReferenceInGusts) {
  Device device;
  for (double time : {0.0, 12.3, 1900.0}) {
    const WindyField field = field_in(WindSource{}, 257, time);
    const PosedField posed = pose(device, field, lanes());
    for (std::size_t i = 0; i < field.blades.size(); ++i)
      for (std::size_t k = 0; k < 7; ++k)
        ASSERT_LT(glm::distance(posed.vertex(i, k), expected_blade(field, i)[k]), gust_error)
            << "vertex " << k << " of blade " << i << " at " << time << " s";
  }
}

TEST_P(PoseGrass, GivesTheBitsOfWidthOne) {
  Device device;
  const WindyField field = field_in(WindSource{}, 257, 3.1);
  EXPECT_EQ(pose(device, field, lanes()).points, pose(device, field, 1).points);
}

TEST(PoseGrassPass, GivesTheBitsOfWidthOne) {
  Device device;
  const WindyField field = field_in(WindSource{}, 255, 3.1);
  EXPECT_EQ(pose(device, field, 0).points, pose(device, field, 1).points);
}

TEST(PoseGrassPass, StandsAtRestWithoutWind) {
  Device device;
  const WindyField field = field_in_steady_wind(0, 257);
  const PosedField posed = pose(device, field, 0);
  const GrassBlades& b = field.blades;
  for (std::size_t i = 0; i < b.size(); ++i) {
    const auto rest = reference::posed_blade(glm::dvec3(b.root_x[i], b.root_y[i], b.root_z[i]) - eye, b.length[i],
                                             b.half_width[i], b.facing[i], {b.bend_x[i], b.bend_y[i]});
    for (std::size_t k = 0; k < 7; ++k) ASSERT_LT(glm::distance(posed.vertex(i, k), rest[k]), steady_error);
  }
}

TEST(PoseGrassPass, KeepsRootsAndLengthsWhateverTheWind) {
  Device device;
  for (double speed : {0.5, 4.0, 12.0, 40.0}) {
    WindSource source;
    source.speed = speed;
    const WindyField field = field_in(source, 257, 7.7);
    const PosedField posed = pose(device, field, 0);
    const GrassBlades& b = field.blades;
    for (std::size_t i = 0; i < b.size(); ++i) {
      const glm::dvec3 root = glm::dvec3(b.root_x[i], b.root_y[i], b.root_z[i]) - eye;
      ASSERT_LT(glm::distance(posed.midline(i, 0), root), steady_error);
      ASSERT_NEAR(glm::distance(posed.vertex(i, 0), posed.vertex(i, 1)), 2 * b.half_width[i], steady_error);
      // Chords of a circular arc at shares 0, 0.4, 0.75, 1: the first points to 0.2 and the last to 0.875 of the tip
      // angle, which gives the angle and with it the arc over each chord, from what was posed alone.
      const glm::dvec3 chord[3] = {posed.midline(i, 1) - posed.midline(i, 0), posed.midline(i, 2) - posed.midline(i, 1),
                                   posed.midline(i, 3) - posed.midline(i, 2)};
      const double between = std::atan2(glm::length(glm::cross(chord[0], chord[2])), glm::dot(chord[0], chord[2]));
      const double angle = between / 0.675, shares[3] = {0.4, 0.35, 0.25};
      ASSERT_LE(angle, 2.5 + 1e-3);
      double length = 0;
      for (int part = 0; part < 3; ++part) {
        const double half = std::max(0.5 * shares[part] * angle, 1e-9);
        length += glm::length(chord[part]) * half / std::sin(half);
      }
      // An error in the angle of 2e-5 changes these lengths by 1e-6.
      ASSERT_NEAR(length, b.length[i], 1e-4 * b.length[i]) << "blade " << i << " at " << speed << " m/s";
    }
  }
}

TEST(PoseGrassPass, LiesDownInAStormAndDoesNotRollUp) {
  Device device;
  WindyField field = field_in_steady_wind(50, 255);
  for (std::size_t i = 0; i < field.blades.size(); ++i) {  // leaning downwind already
    field.blades.bend_x[i] = 2.2f * field.wind.direction_x;
    field.blades.bend_y[i] = 2.2f * field.wind.direction_y;
  }
  const PosedField posed = pose(device, field, 0);
  for (std::size_t i = 0; i < field.blades.size(); ++i) {
    const double length = field.blades.length[i];
    const glm::dvec3 tip = posed.midline(i, 3) - posed.midline(i, 0);
    EXPECT_NEAR(tip.z, length * std::sin(2.5) / 2.5, 1e-5) << "bent to 2.5 rad and no further";
  }
}

TEST(PoseGrassPass, RefusesASeriesOrPlanesThatDoNotFit) {
  Device device;
  World world;
  world.grass = {random_blades(20)};
  Geometry geometry = upload_geometry(device, world);
  const WindyField field = field_in_steady_wind(0.6, 1);
  const SwaySeries series = upload_test_data(device, std::vector<std::array<float, 2>>(32));
  const std::string message = message_of(ErrorKind::unexpected, [&] {
    PoseGrassPass(device).run(geometry.blades, field.wind, series, 0, 256, 0, geometry.posed);
  });
  EXPECT_NE(message.find("32 samples"), std::string::npos) << message;
  EXPECT_NE(message.find("64 samples"), std::string::npos) << message;
}

}  // namespace
}  // namespace understory
