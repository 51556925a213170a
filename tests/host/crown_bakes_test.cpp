// crown-field and crown-baked in whole frames: at rest, under its own horizon, and on planes whose triangles are
// unknown.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/errors.hpp"
#include "tests/support/fragments.hpp"
#include "tests/support/frames.hpp"

namespace understory {
namespace {

/// A shrub, turned and scaled, in still air, all of it in the picture.
Scene still_shrub() {
  Scene scene = one_plant(small_species("shrub"), {3, -2});
  scene.plants[0].spots[0].yaw = 1.1;
  scene.plants[0].spots[0].scale = 1.4;
  scene.wind.speed = 0;
  scene.image = {64, 48};
  scene.camera.position = {3, -7, 1.5};
  scene.camera.target = {3, -2, 0.8};
  scene.methods.tree = "crown-field";
  return scene;
}

Frame render(const Scene& scene, double time = 0) {
  Device device;
  const World world = build_world(scene);
  return FrameRunner(device, world).render(0, time);
}

bool is_plant(const Frame& frame, std::size_t i) {
  return frame.owners[frame.owner[i]].instance >= 0 && frame.owners[frame.owner[i]].crown >= 0;
}

TEST(CrownBakes, FieldOfAStillPlantIsTheSameOnForeignPlanes) {
  UNDERSTORY_NEEDS_DEVICE();
  const Scene scene = still_shrub();
  const World world = build_world(scene);
  Device device;
  const Frame own = FrameRunner(device, world).render(0, 0);
  Frame foreign = own;
  foreign.terms.clear();
  shade_planes(device, &world, scene.methods, 0, foreign);
  std::size_t plant = 0;
  double difference = 0;
  for (std::size_t i = 0; i < own.pixels(); ++i) {
    if (is_background(own, i) || !is_plant(own, i)) continue;
    ++plant;
    // Positions were rounded on their way, so that a few fall into the cell beside.
    difference += std::abs(double(own.terms.at("crown-field")[i]) - double(foreign.terms.at("crown-field")[i]));
  }
  ASSERT_GT(plant, 300u);
  EXPECT_LE(difference / static_cast<double>(plant), 1e-3);
}

TEST(CrownBakes, FacesOfAStillPlantAgreeWithItsField) {
  UNDERSTORY_NEEDS_DEVICE();
  Scene scene = still_shrub();
  const Frame field = render(scene);
  scene.methods.tree = "crown-baked";
  const Frame baked = render(scene);
  double square = 0, sum = 0, count = 0;
  for (std::size_t i = 0; i < field.pixels(); ++i) {
    if (is_background(field, i)) continue;
    if (!is_plant(field, i)) {
      EXPECT_EQ(baked.terms.at("crown-baked")[i], 1);
      continue;
    }
    EXPECT_EQ(baked.visibility[i], baked.terms.at("crown-baked")[i]) << "dimmed by the dome a second time";
    const double difference = double(baked.visibility[i]) - double(field.visibility[i]);
    square += difference * difference;
    sum += difference;
    count += 1;
  }
  EXPECT_LE(std::sqrt(square / count), 0.12);
  EXPECT_NEAR(sum / count, 0, 0.02);
}

/// Root mean square of what `crown-baked` gives the leaves of a nearly bare shrub less what open ground would give
/// them.
double against_open_sky(double wind, double time) {
  Scene scene = still_shrub();
  scene.species[0].leaves = 40;
  scene.methods.tree = "crown-baked";
  scene.wind.speed = wind;
  const Frame frame = render(scene, time);
  double square = 0, count = 0;
  for (std::size_t i = 0; i < frame.pixels(); ++i) {
    if (is_background(frame, i) || frame.owners[frame.owner[i]].surface != SurfaceClass::leaf) continue;
    const double error = double(frame.visibility[i]) - 0.5 * (1 + double(frame.normal[2][i]));
    square += error * error, ++count;
  }
  EXPECT_GT(count, 100) << "leaves are to be seen";
  return std::sqrt(square / count);
}

TEST(CrownBakes, LeavesThatTurnToTheSkySeeMoreOfIt) {
  UNDERSTORY_NEEDS_DEVICE();
  const double still = against_open_sky(0, 0);
  for (const double time : {1.0, 2.0, 3.0}) EXPECT_LE(against_open_sky(14, time), still + 0.015) << time;
}

TEST(CrownBakes, FacesNeedTheTrianglesOfAFrame) {
  UNDERSTORY_NEEDS_DEVICE();
  Scene scene = still_shrub();
  const World world = build_world(scene);
  Device device;
  Frame frame = FrameRunner(device, world).render(0, 0);
  scene.methods.tree = "crown-baked";
  const std::string message =
      message_of(ErrorKind::invalid_input, [&] { shade_planes(device, &world, scene.methods, 0, frame); });
  EXPECT_NE(message.find("crown-baked"), std::string::npos) << message;
  EXPECT_NE(message.find("crown-field"), std::string::npos) << message;
}

TEST(CrownBakes, FieldHoldsTheHorizonAndIsNotDimmedTwice) {
  UNDERSTORY_NEEDS_DEVICE();
  const Frame frame = render(still_shrub());
  for (std::size_t i = 0; i < frame.pixels(); ++i)
    if (!is_background(frame, i) && is_plant(frame, i)) {
      EXPECT_EQ(frame.visibility[i], frame.terms.at("crown-field")[i]);
    }
}

TEST(CrownBakes, FieldFollowsThePlantInTheWind) {
  UNDERSTORY_NEEDS_DEVICE();
  Scene scene = still_shrub();
  const Frame still = render(scene);
  scene.wind.speed = 12;
  const Frame moved = render(scene, 3);
  const auto mean = [](const Frame& frame) {
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < frame.pixels(); ++i)
      if (!is_background(frame, i) && is_plant(frame, i)) sum += double(frame.visibility[i]), ++count;
    return sum / count;
  };
  EXPECT_NE(still.visibility, moved.visibility);
  EXPECT_NEAR(mean(still), mean(moved), 0.03);
  for (std::size_t i = 0; i < moved.pixels(); ++i)
    if (is_plant(moved, i)) {
      EXPECT_EQ(moved.validity[i] & validity::outside_model, 0u);
    }
}

}  // namespace
}  // namespace understory
