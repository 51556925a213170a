// The accuracy table's parts: the judge on a plant small enough for a test, the random crown, the text.
#include "bench/accuracy.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "bench/accuracy_judge.hpp"
#include "bench/random_crown.hpp"
#include "sim/crown.hpp"
#include "sim/files/mesh.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace understory {
namespace {

using testing::HasSubstr;

AccuracySubject small_subject() {
  AccuracySubject subject;
  subject.name = "shrub";
  subject.setting = "dome";
  subject.scene = one_plant(small_species("shrub"));
  subject.scene.wind.speed = 0;
  subject.ground = true;
  return subject;
}

AccuracyOptions few(std::size_t fragments) {
  AccuracyOptions options;
  options.rays = 64;
  options.fragments = fragments;
  return options;
}

Methods constant(double value) {
  Methods methods;
  methods.tree = "ambient";
  methods.ambient = value;
  methods.crowns = "none";
  return methods;
}

TEST(AccuracyJudge, KnowsWhatAConstantReaches) {
  Device device("");
  AccuracySubject subject = small_subject();
  subject.scene.sky = Sky::sphere;
  subject.scene.has_terrain = false;
  AccuracyJudge judge(device, subject, few(100));
  const ErrorStatistics dark = judge.errors(constant(0.1)).at("plant"),
                        bright = judge.errors(constant(0.8)).at("plant");
  EXPECT_EQ(dark.pixels, 400u);
  EXPECT_NEAR(bright.bias - dark.bias, 0.7, 1e-5);
  for (const ErrorStatistics& errors : {dark, bright})
    EXPECT_NEAR(errors.rmse_denoised * errors.rmse_denoised,
                errors.best_constant * errors.best_constant + errors.bias * errors.bias, 1e-6);
  EXPECT_LT(dark.best_constant, std::min(dark.rmse, bright.rmse));
  EXPECT_GT(dark.truth_noise, 0);
}

TEST(AccuracyJudge, JudgesTheGroundApartAndLeavesUnknownMethodsOut) {
  Device device("");
  AccuracyJudge judge(device, small_subject(), few(60));
  const auto errors = judge.errors(constant(0.5));
  ASSERT_TRUE(errors.contains("ground"));
  EXPECT_NEAR(errors.at("ground").reference_mean + errors.at("ground").bias, 1, 1e-6) << "nothing shades the ground";
  EXPECT_GT(errors.at("ground").bias, 0.01) << "but in truth the shrub does";
  Methods unknown;
  unknown.tree = "moonlight";
  EXPECT_TRUE(judge.errors(unknown).empty());
}

TEST(RandomCrown, HasTheOpticalRadiusAskedFor) {
  const TemporaryFolder folder;
  const double radius = 3, optical_radius = 2;
  constexpr std::uint32_t leaves = 5000;
  write_random_crown(folder / "crown.gltf", leaves, radius, optical_radius);
  const RawMesh mesh = read_mesh(folder / "crown.gltf", UpAxis::y, {"leaf*"});
  ASSERT_EQ(mesh.parts.size(), 1u);
  EXPECT_EQ(mesh.parts[0].surface, SurfaceClass::leaf);
  ASSERT_EQ(mesh.parts[0].triangles.size(), 3 * leaves);
  double area = 0, vertical = 0;
  std::vector<glm::vec3> centres;
  for (std::size_t i = 0; i < mesh.parts[0].triangles.size(); i += 3) {
    const auto corner = [&](std::size_t k) { return mesh.parts[0].positions[mesh.parts[0].triangles[i + k]]; };
    const glm::dvec3 twice(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
    area += glm::length(twice) / 2;
    vertical += std::abs(twice.z) / 2;
    centres.push_back((corner(0) + corner(1) + corner(2)) / 3.0f);
  }
  const double density = area / (4 * M_PI / 3 * std::pow(radius, 3));
  EXPECT_NEAR(density / 2 * radius, optical_radius, 1e-3);
  EXPECT_NEAR(vertical / area, 0.5, 0.01) << "spherical leaf angles: G = 1/2";
  const Sphere ball = smallest_sphere(centres);
  EXPECT_NEAR(ball.radius, radius, 0.05);
  EXPECT_NEAR(ball.centre.z, radius, 0.05) << "it stands on the ground";
}

TEST(AccuracyMarkdown, ListsEveryRowAndWhatIsMissing) {
  AccuracyReport report;
  report.rays = 64;
  AccuracyRow row{"oak", "dome", "plant", "crown-field", {}};
  row.errors.rmse_denoised = 0.0714;
  row.errors.bias = -0.012;
  report.rows.push_back(row);
  row.scene = "elm";
  row.method = "sphere-cap";
  report.rows.push_back(row);
  TruthRow truth;
  truth.rays_per_s = 6.54e6;
  truth.fragments = 10;
  truth.inside = 0.951;
  report.truth.push_back(truth);
  report.canopies.push_back({2, 0.2194, 0.001, 0.219384});
  report.unknown = {"moonlight"};
  const std::string text = accuracy_markdown(report);
  EXPECT_THAT(text, HasSubstr("| oak | 0 | 0.000 | 0.000 | 0.000 | 0.071 (-0.012, 0.00) | |"));
  EXPECT_THAT(text, HasSubstr("| elm | 0 | 0.000 | 0.000 | 0.000 | | 0.071"));
  EXPECT_THAT(text, HasSubstr("| 6.5 | 10 | 0.951 |"));
  EXPECT_THAT(text, HasSubstr("| 2 | 0.21940 |"));
  EXPECT_THAT(text, HasSubstr("Not known to this build: `moonlight`."));
}

}  // namespace
}  // namespace understory
