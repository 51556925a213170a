// Pose: rest without wind, wood that does not stretch, joints that hold, nothing remembered between frames.
#include "sim/pose.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "kernels/shared/pose_blade.h"
#include "sim/dynamics.hpp"
#include "sim/limb_pose.hpp"
#include "sim/random.hpp"
#include "sim/terrain.hpp"
#include "sim/wind.hpp"
#include "tests/reference/pose_mesh.hpp"
#include "tests/support/data.hpp"
#include "tests/support/scenes.hpp"

namespace understory {
namespace {

using reference::posed_point;
using reference::posed_vertex;

std::size_t first_plant(const World& world) {
  std::size_t i = 0;
  while (world.instances[i].role != Instance::Role::plant) ++i;
  return i;
}

/// Largest relative change of length over all edges of wood that are longer than 2 mm, against the rest pose.
double largest_strain(const World& world, const Pose& pose, std::size_t i) {
  const Instance& instance = world.instances[i];
  const Prototype& prototype = world.prototypes[instance.prototype];
  const VertexBlocks& v = prototype.vertices;
  double largest = 0;
  for (const TriangleRun& run : prototype.runs) {
    if (run.surface != SurfaceClass::wood) continue;
    for (std::uint32_t t = 3 * run.first; t < 3 * (run.first + run.count); ++t) {
      const std::uint32_t a = prototype.triangles[t], b = prototype.triangles[t % 3 == 2 ? t - 2 : t + 1];
      const double rest =
          instance.scale * glm::distance(glm::dvec3(v.x[a], v.y[a], v.z[a]), glm::dvec3(v.x[b], v.y[b], v.z[b]));
      if (rest < 0.002) continue;
      const double now = glm::distance(posed_vertex(prototype, pose, pose.first_limb[i], a, false),
                                       posed_vertex(prototype, pose, pose.first_limb[i], b, false));
      largest = std::max(largest, std::abs(now / rest - 1));
    }
  }
  return largest;
}

/// Largest gap between where a child limb says its base is and where its parent carries that point, m.
double largest_gap(const World& world, const Pose& pose, std::size_t i) {
  const Prototype& prototype = world.prototypes[world.instances[i].prototype];
  double largest = 0;
  for (std::size_t l = 0; l < prototype.limbs.size(); ++l)
    if (const Limb& limb = prototype.limbs[l]; limb.parent >= 0)
      largest = std::max(
          largest, glm::distance(posed_point(pose.limbs[pose.first_limb[i] + l], glm::dvec3(limb.base)),
                                 posed_point(pose.limbs[pose.first_limb[i] + limb.parent], glm::dvec3(limb.base))));
  return largest;
}

Limb slanted_limb() {
  Limb limb;
  limb.base = {1, -2, 3};
  limb.axis = glm::normalize(glm::vec3(1, 2, 3));
  limb.length = 4;
  limb.reach = 0.05f;
  return limb;
}

TEST(BendLimb, AxisKeepsItsLengthAndTheTipTurnsByTheAngle) {
  const Limb limb = slanted_limb();
  const BentLimb bent = bend_limb(limb, {}, 1, {0.3, 0.1, -0.2});
  const glm::dvec3 axis = glm::normalize(glm::dvec3(limb.axis));
  double length = 0;
  glm::dvec3 last = bent.frame_at(bent.base).base;
  const int pieces = 10'000;
  for (int i = 1; i <= pieces; ++i) {
    const glm::dvec3 next = bent.frame_at(bent.base + axis * (4.0 * i / pieces)).base;
    length += glm::distance(next, last);
    last = next;
  }
  EXPECT_NEAR(length, 4, 1e-6);
  const glm::dvec3 sway{0.3, 0.1, -0.2}, across = sway - glm::dot(sway, axis) * axis;
  const double angle = largest_limb_angle * std::tanh(glm::length(across) / largest_limb_angle);
  const glm::dvec3 tip_axis = bent.frame_at(bent.base + axis * 4.0).rotation * axis;
  EXPECT_NEAR(std::acos(glm::dot(tip_axis, axis)), angle, 1e-9);
  EXPECT_GT(glm::dot(tip_axis - axis, across), 0) << "it bends where it is pushed";
}

TEST(BendLimb, PushedAlongItsAxisItStays) {
  const Limb limb = slanted_limb();
  const BentLimb bent = bend_limb(limb, {}, 1, 0.4 * glm::dvec3(glm::normalize(glm::dvec3(limb.axis))));
  EXPECT_NEAR(bent.curvature + bent.hinge, 0, 1e-7);
}

TEST(BendLimb, CurvatureIsBoundedByReachAndTheRestIsAHinge) {
  Limb limb = slanted_limb();
  limb.reach = 0.5f;
  const BentLimb bent = bend_limb(limb, {}, 1, {2, 0, -1});
  EXPECT_LE(bent.curvature * limb.reach, largest_stretch * (1 + 1e-6));
  EXPECT_GT(bent.hinge, 0.5);
  EXPECT_LT(bent.hinge + bent.curvature * 4, largest_limb_angle);
}

TEST(BendLimb, RecordSaysTheSameAsTheDoubleForm) {
  Random random(1, 1);
  for (int i = 0; i < 200; ++i) {
    const LimbFrame frame{
        glm::mat3_cast(glm::angleAxis(random.uniform(0, 3), glm::normalize(glm::dvec3(1, 2, random.normal())))),
        {10, 20, 5}};
    const double scale = random.uniform(0.5, 2);
    const BentLimb bent = bend_limb(slanted_limb(), frame, scale, {random.normal(), random.normal(), 0});
    const glm::dvec3 eye{9, 18, 4};
    const glm::dvec3 p = bent.base + glm::dvec3(random.normal(), random.normal(), random.normal());
    EXPECT_LT(glm::distance(posed_point(bent.record(eye), p), bent.frame_at(p).base - eye), 2e-5);
  }
}

TEST(Pose, WithoutWindEverythingRests) {
  Scene scene = small_meadow();
  scene.wind.speed = 0;
  const World world = build_world(scene);
  const Pose pose = pose_at(world, 12.3, {0, 0, 0});
  for (std::size_t i = 0; i < world.instances.size(); ++i) {
    const Instance& instance = world.instances[i];
    if (instance.role == Instance::Role::occluder) continue;
    const Prototype& prototype = world.prototypes[instance.prototype];
    const VertexBlocks& v = prototype.vertices;
    const double c = std::cos(instance.yaw), s = std::sin(instance.yaw);
    for (std::size_t vertex = 0; vertex < v.x.size(); vertex += 7) {
      const glm::dvec3 rest(v.x[vertex], v.y[vertex], v.z[vertex]);
      const glm::dvec3 expected =
          instance.position + instance.scale * glm::dvec3(c * rest.x - s * rest.y, s * rest.x + c * rest.y, rest.z);
      ASSERT_LT(glm::distance(posed_vertex(prototype, pose, pose.first_limb[i], vertex), expected), 3e-5);
    }
  }
}

TEST(Pose, WoodKeepsItsLengthsAndJointsHoldInAStorm) {
  for (const char* generator : {"broadleaf", "conifer", "column", "shrub", "birch"}) {
    Scene scene = one_plant(small_species(generator, 2000));
    scene.wind.speed = 25;
    const World world = build_world(scene);
    const std::size_t plant = first_plant(world);
    for (double time : {0.0, 3.7, 100.2}) {
      const Pose pose = pose_at(world, time, {0, -20, 3});
      EXPECT_LT(largest_strain(world, pose, plant), 0.01) << generator << " at " << time << " s";
      EXPECT_LT(largest_gap(world, pose, plant), 1e-3) << generator;
    }
  }
}

TEST(Pose, RealTreesKeepTheirLengthsAndJointsInAStorm) {
  UNDERSTORY_NEEDS_DATA();
  for (const auto& entry : std::filesystem::directory_iterator(data_folder() / "plants")) {
    if (entry.path().extension() != ".glb") continue;
    SpeciesSource species;
    species.name = entry.path().stem();
    species.mesh = entry.path();
    Scene scene = one_plant(species);
    scene.wind.speed = 25;
    const World world = build_world(scene);
    const Pose pose = pose_at(world, 3.7, {0, -20, 3});
    EXPECT_LT(largest_strain(world, pose, first_plant(world)), 0.01) << species.name;
    EXPECT_LT(largest_gap(world, pose, first_plant(world)), 1e-3) << species.name;
  }
}

TEST(Pose, IsAFunctionOfTimeForAnyNumberOfThreads) {
  const World world = build_world(small_meadow());
  const auto bytes_of = [](const Pose& pose) {
    std::string bytes(reinterpret_cast<const char*>(pose.limbs.data()), pose.limbs.size() * sizeof(LimbPose));
    bytes.append(reinterpret_cast<const char*>(pose.grass.data()), pose.grass.size() * sizeof(GrassWind));
    for (const PosedCrown& crown : pose.crowns)
      bytes.append(reinterpret_cast<const char*>(&crown.sphere_centre), sizeof crown.sphere_centre);
    for (const PosedSphere& sphere : pose.spheres)
      bytes.append(reinterpret_cast<const char*>(&sphere.centre), sizeof sphere.centre);
    return bytes;
  };
  const std::string alone = bytes_of(pose_at(world, 2.25, {1, 2, 3}));
  for (double time : {100.0, 0.0, 1.0}) EXPECT_NE(bytes_of(pose_at(world, time, {1, 2, 3})), alone);
  EXPECT_EQ(bytes_of(pose_at(world, 2.25, {1, 2, 3})), alone);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(bytes_of(pose_at(world, 2.25, {1, 2, 3})), alone);
  EXPECT_EQ(bytes_of(pose_at(build_world(small_meadow()), 2.25, {1, 2, 3})), alone);
}

TEST(Pose, TheOriginChangesNothing) {
  Scene far = small_meadow();
  far.origin = {4'500'000.25, 5'400'000.75, 1200};
  const Pose near_pose = pose_at(build_world(small_meadow()), 1.5, {0, -20, 3});
  const Pose far_pose = pose_at(build_world(far), 1.5, {0, -20, 3});
  ASSERT_EQ(near_pose.limbs.size(), far_pose.limbs.size());
  EXPECT_EQ(std::memcmp(near_pose.limbs.data(), far_pose.limbs.data(), near_pose.limbs.size() * sizeof(LimbPose)), 0);
}

TEST(Pose, TheEyeIsSubtractedFromEverything) {
  const World world = build_world(small_meadow());
  const glm::vec3 eye{40, -30, 7};
  const Pose here = pose_at(world, 1.5, {0, 0, 0}), there = pose_at(world, 1.5, glm::dvec3(eye));
  for (std::size_t limb = 0; limb < here.limbs.size(); limb += 5)
    for (int row = 0; row < 3; ++row)
      EXPECT_NEAR(here.limbs[limb].to_scene[4 * row + 3] - there.limbs[limb].to_scene[4 * row + 3], eye[row], 1e-5);
  for (std::size_t i = 0; i < here.crowns.size(); ++i)
    EXPECT_LT(glm::distance(here.crowns[i].sphere_centre - there.crowns[i].sphere_centre, eye), 1e-5);
  for (std::size_t i = 0; i < here.spheres.size(); ++i)
    EXPECT_LT(glm::distance(here.spheres[i].centre - there.spheres[i].centre, eye), 1e-5);
}

TEST(Pose, GustsTravelDownwind) {
  Scene scene = one_plant(small_species("birch"));
  scene.wind.direction = 0.6;
  const World here = build_world(scene);
  const double distance = 35;
  scene.plants[0].spots[0].at = distance * here.wind->direction();
  const World downwind = build_world(scene);
  const double travel = distance / here.wind->convection_speed();
  const Pose now = pose_at(here, 8, {0, 0, 0}), later = pose_at(downwind, 8 + travel, {0, 0, 0});
  ASSERT_EQ(now.limbs.size(), later.limbs.size());
  double change = 0;
  const Pose same_time = pose_at(downwind, 8, {0, 0, 0});
  for (std::size_t limb = 0; limb < now.limbs.size(); ++limb) {
    EXPECT_NEAR(now.limbs[limb].curvature, later.limbs[limb].curvature, 1e-6);
    EXPECT_NEAR(now.limbs[limb].to_limb[0], later.limbs[limb].to_limb[0], 1e-5);
    change = std::max(change, std::abs(double(now.limbs[limb].curvature) - same_time.limbs[limb].curvature));
  }
  EXPECT_GT(change, 1e-4);
}

TEST(Blade, MidlineKeepsItsLengthHoweverItBends) {
  for (double bend : {0.0, 0.3, 1.2, 2.4}) {
    double length = 0;
    BladePoint last = blade_midline(0.4, 0.6 * bend, 0.8 * bend, 0);
    for (int i = 1; i <= 1000; ++i) {
      const BladePoint next = blade_midline(0.4, 0.6 * bend, 0.8 * bend, i / 1000.0);
      length += std::hypot(next.x - last.x, next.y - last.y, next.z - last.z);
      last = next;
    }
    EXPECT_NEAR(length, 0.4, 1e-5) << bend;
  }
}

TEST(Pose, ExtremeWindStaysFinite) {
  Scene scene = small_meadow();
  scene.wind.speed = 200;
  scene.wind.turbulence_intensity = 3;
  const World world = build_world(scene);
  for (double time : {-1e6, 0.0, 1e9}) {
    const Pose pose = pose_at(world, time, {0, 0, 0});
    for (const LimbPose& limb : pose.limbs) {
      for (int i = 0; i < 12; ++i) ASSERT_TRUE(std::isfinite(limb.to_limb[i]) && std::isfinite(limb.to_scene[i]));
      ASSERT_TRUE(std::isfinite(limb.curvature) && std::isfinite(limb.flutter_amplitude));
      ASSERT_GE(limb.flutter_phase, 0);
      ASSERT_LT(limb.flutter_phase, 6.2831854f);
    }
    for (const PosedCrown& crown : pose.crowns) ASSERT_TRUE(std::isfinite(glm::length(crown.sphere_centre)));
  }
}

TEST(Pose, CrownsMoveWithTheirTrunkAndScaleWithTheirPlant) {
  Scene scene = one_plant(small_species("birch"));
  scene.plants[0].spots[0].scale = 2;
  const World world = build_world(scene);
  const Prototype& prototype = world.prototypes.back();
  const CrownShell& shell = prototype.crown;
  const std::size_t plant = first_plant(world);
  for (double time : {0.0, 2.0, 5.0}) {
    const Pose pose = pose_at(world, time, {0, 0, 0});
    ASSERT_EQ(pose.crowns.size(), 1u);
    EXPECT_FLOAT_EQ(pose.crowns[0].sphere_radius, 2 * shell.sphere_radius);
    EXPECT_FLOAT_EQ(pose.crowns[0].alpha_rho, world.crown_models[0].alpha_rho / 8);
    // A point of the trunk's axis at the crown's height is carried by the same piece of wood: its distance stays.
    const Limb& trunk = prototype.limbs[shell.limb];
    const glm::dvec3 on_axis = glm::dvec3(trunk.base) + double(shell.trunk_height) * glm::dvec3(trunk.axis);
    const glm::dvec3 posed = posed_point(pose.limbs[pose.first_limb[plant] + shell.limb], on_axis);
    EXPECT_NEAR(glm::distance(posed, glm::dvec3(pose.crowns[0].sphere_centre)),
                2 * glm::distance(on_axis, glm::dvec3(shell.sphere_centre)), 1e-4);
    EXPECT_NEAR(glm::determinant(pose.crowns[0].ellipsoid_axes), glm::determinant(shell.ellipsoid_axes), 1e-5);
  }
}

TEST(Pose, LeavesFlutterMoreInMoreWind) {
  double last = 0;
  for (double speed : {1.0, 3.0, 9.0}) {
    Scene scene = one_plant(small_species("broadleaf"));
    scene.wind.speed = speed;
    const World world = build_world(scene);
    double mean = 0;
    for (int i = 0; i < 100; ++i) mean += pose_at(world, i, {0, 0, 0}).limbs.back().flutter_amplitude / 100;
    EXPECT_GT(mean, last);
    EXPECT_LE(mean, world.prototypes.back().flutter_scale / 127);
    last = mean;
  }
}

TEST(Pose, OccludersFollowTheirPathsOverTheGround) {
  Scene scene = small_meadow();
  scene.terrain.height = 7;
  const World world = build_world(scene);
  const Pose pose = pose_at(world, 2, {0, 0, 0});
  std::size_t ball = 0;
  while (world.instances[ball].occluder != 0) ++ball;
  EXPECT_LT(glm::distance(posed_point(pose.limbs[pose.first_limb[ball]], {0, 0, 0}), {5, 1, 7.4}), 1e-5);
  EXPECT_LT(glm::distance(pose.spheres[0].centre, {5, 1, 7.4}), 1e-5);
  // The leg's cycle of one second goes on while the body walks for ten.
  std::size_t animal = ball + 1;
  const auto leg_in_body = [&](double time) {
    const Pose now = pose_at(world, time, {0, 0, 0});
    const LimbPose &body = now.limbs[now.first_limb[animal]], &leg = now.limbs[now.first_limb[animal] + 1];
    return glm::dot(posed_point(leg, {0, 0, 1}) - posed_point(leg, {0, 0, 0}),
                    posed_point(body, {1, 0, 0}) - posed_point(body, {0, 0, 0}));
  };
  EXPECT_NEAR(leg_in_body(4.5), std::sin(0.4), 1e-5);
  EXPECT_NEAR(leg_in_body(7), -std::sin(0.4), 1e-5);
}

}  // namespace
}  // namespace understory
