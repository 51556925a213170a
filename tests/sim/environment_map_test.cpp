// Prefiltered environment maps: constant maps stay constant, a cap's means are closed forms, a photographed sky's
// tables are close to quadrature over its pixels.
#include "sim/environment.hpp"

#include <gtest/gtest.h>

#include "kernels/shared/cone.h"
#include "kernels/shared/environment.h"
#include "sim/random.hpp"
#include "tests/reference/environment.hpp"
#include "tests/support/data.hpp"
#include "tests/support/environments.hpp"
#include "viz/exr/environment.hpp"

namespace understory {
namespace {

const double pi = std::numbers::pi;

glm::dvec3 some_direction(Random& random) {
  const double z = random.uniform(-1, 1), turn = random.uniform(0, 2 * pi), flat = std::sqrt(1 - z * z);
  return {flat * std::cos(turn), flat * std::sin(turn), z};
}

TEST(Environment, LooksWhereItsPixelsAre) {
  EnvironmentMap map = constant_environment(glm::vec3(0), 16);
  const auto paint = [&](int row, int column, glm::vec3 colour) { map.radiance[row * 32 + column] = colour; };
  for (int column = 0; column < 32; ++column) paint(0, column, {0, 0, 1});
  for (const int row : {7, 8})
    for (const int column : {15, 16}) paint(row, column, {1, 0, 0});  // the middle
  for (const int row : {7, 8})
    for (const int column : {7, 8}) paint(row, column, {0, 1, 0});  // half way to its left border
  EXPECT_EQ(radiance_towards(map, 0, {1, 0, 0}), glm::vec3(1, 0, 0));
  EXPECT_EQ(radiance_towards(map, 0, {0, 2, 0}), glm::vec3(0, 1, 0));
  EXPECT_EQ(radiance_towards(map, 0, {0, 0, 1}), glm::vec3(0, 0, 1));
  EXPECT_EQ(radiance_towards(map, 0, {0, 0, -1}), glm::vec3(0));
  EXPECT_EQ(radiance_towards(map, pi / 2, {0, 1, 0}), glm::vec3(1, 0, 0));  // turned counter-clockwise
}

TEST(Environment, OctahedronIsUnfoldedAndFoldedBack) {
  for (int i = 0; i < 2000; ++i) {
    Random random(5, stream_of("octahedron"), static_cast<std::uint64_t>(i));
    const glm::dvec3 d = some_direction(random);
    const OctahedralPlace place = octahedral_place(d.x, d.y, d.z);
    const glm::dvec2 other = reference::folded_out(d);
    ASSERT_NEAR(place.u, other.x, 1e-12);
    ASSERT_NEAR(place.v, other.y, 1e-12);
    const OctahedralDirection back = octahedral_direction(place);
    ASSERT_NEAR(glm::length(glm::cross(d, glm::dvec3(back.x, back.y, back.z))), 0, 1e-12);
    ASSERT_GT(glm::dot(d, glm::dvec3(back.x, back.y, back.z)), 0);
  }
}

TEST(Environment, AConstantMapIsConstant) {
  for (const Sky sky : {Sky::dome, Sky::sphere})
    for (const int height : {1, 7, 600}) {
      const glm::vec3 colour(0.3f, 2.0f, 40.0f);
      const PrefilteredEnvironment e = prefilter(constant_environment(colour, height), 0.7, sky, {9, 9, 5});
      for (const std::vector<float>* table : {&e.normals, &e.cones})
        for (std::size_t i = 0; i < table->size(); i += 4)
          for (int channel = 0; channel < 3; ++channel)
            ASSERT_NEAR((*table)[i + static_cast<std::size_t>(channel)] / colour[channel], 1, 1e-5);
      EXPECT_NEAR(e.mean.g, 2, 1e-5);
    }
}

/// Every node of both tables against the closed forms, for a map that is 1 in a cap.
TEST(Environment, ACapIsItsClosedForm) {
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1, -2, 1.5));
  const double half_angle = 0.8, cap = (1 - std::cos(half_angle)) / 2;
  const PrefilterSize size{9, 9, 9};
  const PrefilteredEnvironment e = prefilter(cap_environment(axis, std::cos(half_angle)), 0, Sky::sphere, size);
  for (std::uint32_t node = 0; node < 81; ++node) {
    const OctahedralDirection d = octahedral_direction({(node % 9) / 8.0, (node / 9) / 8.0});
    const double cosine = glm::dot(glm::normalize(glm::dvec3(d.x, d.y, d.z)), axis);
    EXPECT_NEAR(e.normals[4 * node], clip_cosine(cap, cosine), 0.01);
    for (std::uint32_t level = 4; level < 9; ++level) {  // wider than the nodes are apart
      const double aperture = level * level / 64.0;
      EXPECT_NEAR(e.cones[4 * (level * 81 + node)], overlap_of_apertures(cap, aperture, cosine) / aperture, 0.01)
          << node << ' ' << level;
    }
  }
}

TEST(Environment, UnderADomeOnlyWhatIsAboveTheHorizonCounts) {
  const auto half = [](glm::dvec3 d) { return glm::vec3(d.z > 0 ? 1.0f : 100.0f); };
  const PrefilteredEnvironment e = prefilter(made_environment(64, half), 0, Sky::dome, {9, 9, 9});
  for (std::size_t i = 0; i < e.cones.size(); i += 4) EXPECT_NEAR(e.cones[i], 1, 1e-4);
  for (std::size_t i = 0; i < e.normals.size(); i += 4) EXPECT_NEAR(e.normals[i], 1, 1e-4);
}

/// Mean over a cone, pixel by pixel.
glm::dvec3 counted_cone(const EnvironmentMap& map, glm::dvec3 axis, double cosine) {
  glm::dvec3 light(0);
  double area = 0;
  for (int row = 0; row < map.height; ++row) {
    const double polar = pi * (row + 0.5) / map.height;
    for (int column = 0; column < map.width; ++column) {
      const double azimuth = 2 * pi * (0.5 - (column + 0.5) / map.width);
      const glm::dvec3 d(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar));
      if (glm::dot(d, axis) < cosine) continue;
      light += std::sin(polar) * glm::dvec3(map.radiance[std::size_t(row) * std::size_t(map.width) + column]);
      area += std::sin(polar);
    }
  }
  return light / area;
}

/// Of an occluded cone's light as a share of the mean sky: the aperture times the error of its mean radiance.
double table_error(const EnvironmentMap& map, PrefilterSize size) {
  const PrefilteredEnvironment e = prefilter(map, 0, Sky::sphere, size);
  double squares = 0;
  constexpr int cones = 60;
  for (int i = 0; i < cones; ++i) {
    Random random(7, stream_of("cones"), static_cast<std::uint64_t>(i));
    const glm::dvec3 axis = some_direction(random);
    const double aperture = random.uniform(0.01, 0.5);
    const double error = reference::in_cone(e, axis, aperture).g - counted_cone(map, axis, 1 - 2 * aperture).g;
    squares += std::pow(2 * aperture * error / double(e.mean.g), 2);
  }
  return std::sqrt(squares / cones);
}

TEST(Environment, TablesOfAPhotographedSkyAreCloseToQuadrature) {
  UNDERSTORY_NEEDS_DATA();
  const EnvironmentMap map = read_environment(data_folder() / "env/forest.exr");
  EXPECT_EQ(map.width, 1024);
  for (const PrefilterSize size : {PrefilterSize{33, 9, 9}, {33, 17, 13}, {33, 33, 17}, {33, 33, 25}})
    std::printf("%u nodes a side, %u apertures, %4.0f KiB: RMSE %.5f of the mean sky\n", size.cone_nodes,
                size.cone_levels, size.cone_nodes * size.cone_nodes * size.cone_levels / 64.0, table_error(map, size));
  EXPECT_LT(table_error(map, {}), 0.01);
}

}  // namespace
}  // namespace understory
