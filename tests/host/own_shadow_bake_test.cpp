// What bodies take from their own surface: closed forms, traced truth, 8 bits, and what must not matter.
#include "host/trace/own_shadow_bake.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>

#include "host/trace/directions.hpp"
#include "host/trace/tracer.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/grids.hpp"

namespace understory {
namespace {

OwnShadow shadow_of(const TestMesh& mesh, std::uint32_t rays = 64) {
  return bake_own_shadow(mesh.vertices, mesh.triangles, rays, 1);
}

/// The lower half of a sphere of radius 1 about the origin, without thickness.
TestMesh bowl() {
  constexpr std::uint32_t rings = 24, turns = 48;
  TestMesh mesh;
  for (std::uint32_t i = 0; i <= rings; ++i)
    for (std::uint32_t j = 0; j < turns; ++j) {
      const double down = 0.5 * std::numbers::pi * i / rings, turn = 2 * std::numbers::pi * j / turns;
      mesh.vertices.emplace_back(std::cos(down) * std::cos(turn), std::cos(down) * std::sin(turn), -std::sin(down));
    }
  for (std::uint32_t i = 0; i < rings; ++i)
    for (std::uint32_t j = 0; j < turns; ++j) {
      const std::uint32_t a = i * turns + j, b = i * turns + (j + 1) % turns;
      for (const std::uint32_t index : {a, a + turns, b, b, a + turns, b + turns}) mesh.triangles.push_back(index);
    }
  return mesh;
}

TEST(OwnShadowBake, ConvexBodiesHaveNone) {
  EXPECT_EQ(shadow_of(cube()).size, 0u);
  EXPECT_EQ(shadow_of(TestMesh().add(ellipsoid_part({0.5, 1, 1.4}))).size, 0u);
  EXPECT_EQ(own_share(shadow_of(cube()), glm::dvec3(0.5), glm::dvec3(0, 0, 1)), 0);
}

TEST(OwnShadowBake, ABowlSeesHalfOfItsSphereAndNothingOutside) {
  // From a point of a sphere, every part of it takes its share of the whole area.
  const OwnShadow shadow = shadow_of(bowl());
  const OwnShadow stored = unpacked(shadow, packed_own_shadow(shadow));
  double worst_bits = 0;
  for (int i = 0; i < 400; ++i) {
    const double down = std::asin((i % 20 + 1.0) / 21), turn = 0.37 * i;
    const glm::dvec3 out(std::cos(down) * std::cos(turn), std::cos(down) * std::sin(turn), -std::sin(down));
    EXPECT_NEAR(own_share(shadow, out, -out), 0.5, 0.04) << i;
    EXPECT_NEAR(own_share(shadow, out, out), 0, 0.04) << i;
    worst_bits =
        std::max(worst_bits, std::abs(double(own_share(stored, out, -out)) - double(own_share(shadow, out, -out))));
  }
  EXPECT_LT(worst_bits, 4.0 / 254);
}

TEST(OwnShadowBake, ATableIsNearItsTruth) {
  const TestMesh mesh = table();
  const OwnShadow shadow = shadow_of(mesh);
  const Tracer tracer(mesh.vertices, mesh.triangles);
  double sum = 0;
  std::size_t count = 0;
  for (int i = 0; i < 400; ++i) {  // below the top, away from the legs
    const glm::vec3 at(-0.55f + 1.1f * static_cast<float>(i % 20) / 19, -0.3f + 0.6f * static_cast<float>(i / 20) / 19,
                       0.9f);
    std::vector<Ray> rays(512);
    std::vector<std::uint8_t> blocked(512);
    for (std::uint32_t k = 0; k < 512; ++k) {
      const glm::vec3 d = cosine_hemisphere(scrambled_sobol(k, static_cast<std::uint32_t>(i)));
      rays[k].origin = at - glm::vec3(0, 0, 1e-4f);
      rays[k].direction = glm::vec3(d.x, d.y, -d.z);
    }
    tracer.blocked(rays, blocked);
    const double truth = static_cast<double>(std::count(blocked.begin(), blocked.end(), 1)) / 512;
    sum += std::pow(double(own_share(shadow, glm::dvec3(at), glm::dvec3(0, 0, -1))) - truth, 2);
    ++count;
  }
  EXPECT_LT(std::sqrt(sum / static_cast<double>(count)), 0.015);
}

TEST(OwnShadowBake, TheSameBitsForAnyThreadCount) {
  const OwnShadow all = shadow_of(table(), 16);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const OwnShadow single = shadow_of(table(), 16);
  EXPECT_EQ(all.fit, single.fit);
}

TEST(OwnShadowBake, FlatBodiesAndMeshesWithoutArea) {
  TestMesh sheet;
  sheet.vertices = {glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)};
  sheet.triangles = {0, 1, 2};
  EXPECT_EQ(shadow_of(sheet).size, 0u);
  sheet.vertices[2] = glm::vec3(2, 0, 0);
  EXPECT_NE(message_of(ErrorKind::invalid_input, [&] { shadow_of(sheet); }).find("no area"), std::string::npos);
}

}  // namespace
}  // namespace understory
