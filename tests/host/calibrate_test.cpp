// Calibration: what is known of random crowns comes out, the models' order on real plants, and the bounds that
// crown-transmittance is held to.
#include "host/trace/calibrate.hpp"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <map>

#include "host/trace/calibrated_world.hpp"
#include "host/trace/crown_points.hpp"
#include "host/trace/truth.hpp"
#include "kernels/shared/crown_transmittance.h"
#include "sim/files/mesh.hpp"
#include "sim/transmittance_fit.hpp"
#include "tests/support/data.hpp"
#include "tests/support/random_crown.hpp"
#include "tests/support/scenes.hpp"

namespace understory {
namespace {

TEST(Calibrate, FindsTheDensityOfARandomCrown) {
  const Prototype crown = random_crown_prototype(60'000, 2);
  const Calibration calibration = calibrate(crown);
  EXPECT_NEAR(calibration.leaf_area, 2 * 8 * M_PI / 3, 1e-3);
  EXPECT_EQ(calibration.plant_area, calibration.leaf_area);
  // The shells hold whole leaves: they are larger than the ball of their centres by 1 to 2 % of its radius.
  EXPECT_NEAR(calibration.k, 2, 0.25);
  EXPECT_NEAR(calibration.clumping, 1, 0.1);
  EXPECT_NEAR(calibration.open_error, 0, 0.01);
  EXPECT_NEAR(calibration.model.opacity, 1 - disc_transmittance(2), 0.03);
  EXPECT_NEAR(calibration.transmittance.at("sphere")[0], 2, 0.3);
  EXPECT_NEAR(calibration.transmittance.at("sphere")[1], 1, 0.05);
  EXPECT_LT(calibration.rmse_heldout.at("crown-transmittance"), 0.5 * calibration.rmse_heldout.at("ambient"));
  double area = 0;
  const DensityGrid& grid = calibration.density;
  const glm::vec3 cell = (grid.high - grid.low) / glm::vec3(grid.cells);
  for (const float density : grid.density) area += double(density * cell.x * cell.y * cell.z);
  EXPECT_NEAR(area, calibration.plant_area, 1e-3 * area);
}

TEST(Calibrate, DependsNeitherOnThreadsNorOnWhatRanBefore) {
  const Prototype crown = random_crown_prototype(2000, 1);
  CalibrationOptions few;
  few.points = 300;
  few.rays = 64;
  few.lines = 1000;
  const Calibration here = calibrate(crown, 0, few);
  tbb::task_arena alone(1);
  const Calibration there = alone.execute([&] { return calibrate(crown, 0, few); });
  EXPECT_EQ(here.rmse_heldout, there.rmse_heldout);
  EXPECT_EQ(here.model.extinction, there.model.extinction);
  EXPECT_EQ(here.model.shell_opacity, there.model.shell_opacity);
  EXPECT_EQ(here.k, there.k);
}

TEST(Calibrate, NothingWithoutACrown) {
  const Calibration calibration = calibrate(Prototype{});
  EXPECT_EQ(calibration.leaf_area, 0);
  EXPECT_EQ(calibration.model.opacity, 0);
  EXPECT_TRUE(calibration.rmse_heldout.empty());
}

TEST(Calibrate, KeepsWhatTheSceneGives) {
  SpeciesSource species = small_species("broadleaf");
  species.alpha_rho = 0.125;
  species.reeves_blau_ambient = 0.5;
  species.reeves_blau_extinction = 0.25;
  World world = build_world(one_plant(species));
  calibrate_world(world);
  EXPECT_EQ(world.crown_models[0].alpha_rho, 0.125f);
  EXPECT_EQ(world.crown_models[0].alpha_rho_shells, 0.125f);
  EXPECT_EQ(world.crown_models[0].reeves_blau_ambient, 0.5f);
  EXPECT_EQ(world.crown_models[0].reeves_blau_extinction, 0.25f);
  EXPECT_GT(world.crown_models[0].extinction, 0);
}

struct Fit {
  double bias = 0, rmse = 0;
  double constant = 0;  // rmse of the best constant
  double scatter = 0;   // of the truth among points of like depth and normal: what no function of these can explain
};

/// crown-transmittance with k from the leaf area alone, nothing fitted to the truth.
Fit judge(const CrownPoints& points, double optical) {
  const TransmittanceShell shell = fit_transmittance(glm::dmat3(1), glm::dvec3(1), optical, false);
  const auto count = static_cast<double>(points.positions.size());
  Fit fit;
  double mean = 0, square = 0;
  std::map<std::pair<int, int>, std::array<double, 3>> bins;  // count, sum, sum of squares
  for (std::size_t i = 0; i < points.positions.size(); ++i) {
    const glm::dvec3 p = glm::dvec3(points.positions[i]) - glm::dvec3(0, 0, 1), n(points.normals[i]);
    const double v = points.visibility[i];
    const double error = crown_transmittance(shell, p.x, p.y, p.z, n.x, n.y, n.z, false) - v;
    fit.bias += error / count;
    fit.rmse += error * error / count;
    mean += v / count;
    square += v * v / count;
    const double depth = std::max(1 - glm::length(p), 0.0);
    auto& [members, sum, squares] = bins[{int(8 * std::exp(-(1 + optical) * depth)), int(4 * glm::dot(p, n) + 4)}];
    members += 1, sum += v, squares += v * v;
  }
  double within = 0, freedom = 0;
  for (const auto& [place, bin] : bins) within += bin[2] - bin[1] * bin[1] / bin[0], freedom += bin[0] - 1;
  fit.scatter = std::sqrt(within / freedom);
  fit.rmse = std::sqrt(fit.rmse);
  fit.constant = std::sqrt(square - mean * mean);
  return fit;
}

/// Points on both sides of all leaves alike, seen or not.
CrownPoints points_on_leaves(const Tracer& tracer, const Prototype& crown, std::uint32_t count, int rays) {
  CrownPoints points;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t triangle = i * (crown.triangle_count() / count);
    const auto corner = [&](std::uint32_t k) {
      const std::uint32_t v = crown.triangles[3 * triangle + k];
      return glm::vec3(crown.vertices.x[v], crown.vertices.y[v], crown.vertices.z[v]);
    };
    const glm::vec3 normal = glm::normalize(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
    points.positions.push_back((corner(0) + corner(1) + corner(2)) / 3.0f);
    points.normals.push_back(i % 2 ? normal : -normal);
  }
  TruthOptions options;
  options.rays = rays;
  options.sky = Sky::sphere;
  points.visibility = trace_truth(tracer, points.positions, points.normals, options).visibility;
  return points;
}

TEST(CrownTransmittanceTruth, IsTheMeanOfRandomCrowns) {
  for (const double optical : {0.25, 1.0, 4.0, 16.0}) {
    const Prototype crown = random_crown_prototype(200'000, optical);
    const Tracer tracer = trace_prototype(crown);
    const Fit all = judge(points_on_leaves(tracer, crown, 1500, 256), optical);
    const Fit seen = judge(seen_points(tracer, crown, 1500, 256, 5), optical);
    std::cout << "kR " << optical << ": all leaves: bias " << all.bias << ", rmse " << all.rmse << "; as seen: bias "
              << seen.bias << ", rmse " << seen.rmse << ", best constant " << seen.constant << ", scatter of the truth "
              << seen.scatter << '\n';
    EXPECT_NEAR(all.bias, 0, 0.004) << optical;
    EXPECT_LE(all.rmse, 1.02 * all.scatter) << optical;
    // A point that is seen has one open direction at least, and leaves have a size: denser crowns look too dark.
    EXPECT_LE(seen.rmse, 1.15 * seen.scatter) << optical;
    EXPECT_LT(seen.rmse, 0.5 * seen.constant) << optical;
  }
}

TEST(CrownTransmittanceTruth, BeatsSphereCapAndTheBestConstantOnRealPlants) {
  UNDERSTORY_NEEDS_DATA();
  for (const char* file :
       {"tree_broadleaf_black_oak", "tree_poplar_lombardy", "shrub_bougainvillea", "tree_walnut_digitized",
        "tree_scanned_qsm_coffeetree", "sapling_eucalyptus_pilularis", "birch"}) {
    SpeciesSource source;
    source.name = file;
    source.mesh = data_folder() / "plants" / (std::string(file) + ".glb");
    const RawMesh mesh = read_mesh(source.mesh, UpAxis::y, source.leaf_materials);
    CalibrationOptions options;
    options.points = 2000;
    options.rays = 128;
    const auto rmse = calibrate(build_species(source, 1, &mesh).prototype, 0, options).rmse_heldout;
    EXPECT_LT(rmse.at("crown-transmittance"), rmse.at("sphere-cap")) << file;
    EXPECT_LT(rmse.at("crown-transmittance"), rmse.at("ambient")) << file;
  }
}

}  // namespace
}  // namespace understory
