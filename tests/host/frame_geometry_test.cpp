// What the planes of a frame say about space: pixels, positions, normals, owners and the posed triangles agree.
#include <gtest/gtest.h>

#include <cmath>

#include "host/frame/camera_view.hpp"
#include "tests/reference/rasterise.hpp"
#include "tests/support/frames.hpp"

namespace understory {
namespace {

/// Where a frame's header camera sees a position: pixels from the top left corner, and metres ahead.
glm::dvec3 project(const Frame& frame, glm::dvec3 position) {
  const glm::dvec3 p(frame.world_to_camera * glm::dvec4(position, 1));
  const double focal = 0.5 * frame.height / std::tan(0.5 * frame.vertical_fov);
  return {0.5 * frame.width + focal * p.x / -p.z, 0.5 * frame.height - focal * p.y / -p.z, -p.z};
}

void expect_sound_geometry(const Frame& frame, glm::dvec3 eye, glm::dvec2 offset) {
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) + static_cast<std::size_t>(x);
      if (is_background(frame, i)) continue;
      const glm::dvec3 position = position_at(frame, i), normal = normal_at(frame, i);
      const glm::dvec3 seen = project(frame, position);
      ASSERT_NEAR(seen.x, x + 0.5 + offset.x, 0.01) << x << ", " << y;
      ASSERT_NEAR(seen.y, y + 0.5 + offset.y, 0.01) << x << ", " << y;
      ASSERT_NEAR(seen.z, frame.depth[i], 1e-5 * seen.z + 1e-5);
      ASSERT_NEAR(glm::length(normal), 1, 1e-5);
      ASSERT_LE(glm::dot(normal, glm::normalize(position - eye)), 1e-5) << "faces away from the viewer";
    }
}

TEST(FrameGeometry, PositionsReprojectToTheirPixelsAndNormalsFaceTheViewer) {
  const World world = build_world(meadow_view());
  Device device;
  FrameRunner runner(device, world);
  for (const glm::dvec2 offset : {glm::dvec2(0), glm::dvec2(0.5), glm::dvec2(-0.5, 0.25)})
    expect_sound_geometry(runner.render(0, 0, offset), world.scene.camera.position, offset);
}

TEST(FrameGeometry, HoldsFromAboveAndFromBelow) {
  Scene scene = meadow_view();
  for (const double height : {30.0, -5.0}) {
    scene.camera.position = {-10, 2, height};
    scene.camera.target = {-10, 2, height - std::copysign(1, height)};
    const World world = build_world(scene);
    Device device;
    const Frame frame = FrameRunner(device, world).render(0, 0);
    expect_sound_geometry(frame, scene.camera.position, glm::dvec2(0));
    EXPECT_FALSE(is_background(frame, frame.pixels() / 2));
  }
}

TEST(FrameGeometry, OffsetSamplesAreThePixelsOfALargerPicture) {
  Scene scene = meadow_view();
  const World world = build_world(scene);
  const int width = scene.image.width, height = scene.image.height;
  scene.image = {2 * width, 2 * height};
  const World large_world = build_world(scene);
  Device device;
  const Frame large = FrameRunner(device, large_world).render(0, 0);
  FrameRunner runner(device, world);
  int different = 0;
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < 2; ++column) {
      const Frame small = runner.render(0, 0, {0.5 * column - 0.25, 0.5 * row - 0.25});
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          const auto i = static_cast<std::size_t>(y * width + x);
          const auto j = static_cast<std::size_t>((2 * y + row) * 2 * width + 2 * x + column);
          different += small.owner[i] != large.owner[j] ||
                       (small.owner[i] != 0 && std::abs(small.depth[i] - large.depth[j]) > 1e-4 * large.depth[j]);
        }
    }
  // Corners snap to 1/256 pixel, and pixels are twice as large: leaf edges fall either way.
  EXPECT_LE(different, 4 * width * height / 100);
}

TEST(FrameGeometry, TheCentreOfAnyOddPictureIsTheSameFragment) {
  Scene scene = meadow_view();
  scene.camera.target = {-5, 0, 0.4};  // the ball
  const Frame usual = [&] {
    const World world = build_world(scene);
    Device device;
    return FrameRunner(device, world).render(0, 0);
  }();
  const std::size_t usual_centre = usual.pixels() / 2;
  ASSERT_EQ(usual.owners[usual.owner[usual_centre]].species, "ball");
  for (const ImageSize size : {ImageSize{1, 1}, {17, 1}, {1, 17}, {5, 3}, {255, 257}}) {
    scene.image = size;
    const World world = build_world(scene);
    Device device;
    const Frame frame = FrameRunner(device, world).render(0, 0);
    const std::size_t centre = frame.pixels() / 2;
    EXPECT_EQ(frame.owner[centre], usual.owner[usual_centre]) << size.width << " x " << size.height;
    EXPECT_NEAR(frame.depth[centre], usual.depth[usual_centre], 2e-5) << size.width << " x " << size.height;
    // Distant spheres may be approximated together, by tile (host/passes/solid_angle.hpp).
    EXPECT_NEAR(frame.visibility[centre], usual.visibility[usual_centre], 1.0 / 128);
  }
}

TEST(FrameGeometry, PosedTrianglesAreTheOnesThatRaysSee) {
  Scene scene = meadow_view();
  scene.image = {41, 29};
  const World world = build_world(scene);
  Device device;
  FrameRunner runner(device, world);
  const Frame frame = runner.render(0, 0);
  const PosedGeometry posed = runner.posed_geometry();
  ASSERT_EQ(posed.triangles.size(), 3 * posed.owner.size());
  std::vector<glm::dvec3> vertices;
  for (std::size_t i = 0; i < posed.positions.size(); i += 3)
    vertices.push_back(glm::dvec3(posed.positions[i], posed.positions[i + 1], posed.positions[i + 2]) -
                       scene.camera.position);
  const CameraView camera = camera_view(scene.camera, scene.image, glm::dvec2(0));
  int different = 0, covered = 0;
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const auto i = static_cast<std::size_t>(y * frame.width + x);
      const reference::Hit hit = reference::trace_pixel(camera, vertices, posed.triangles, x, y);
      const std::uint32_t owner = hit.triangle == 0xffffffffu ? 0 : posed.owner[hit.triangle];
      covered += owner != 0;
      different += owner != frame.owner[i] ||
                   (owner != 0 && std::abs(hit.depth - frame.depth[i]) > 1e-4 * frame.depth[i] + 1e-4);
    }
  EXPECT_GT(covered, frame.width * frame.height / 2);
  // Leaves and blades are a few pixels across here: the 1/256 pixel raster of corners decides some of their edges.
  EXPECT_LE(different, covered / 50);
}

TEST(FrameGeometry, BladesThatOnlyFillTheirGroupMakeNoPixel) {
  // One blade 10 m away; the 255 that pad its group have no length and stand at the origin, right before the camera.
  Scene scene = open_ground();
  scene.has_terrain = false;
  scene.camera.position = {0, -0.5, 0.05};
  scene.camera.target = {0, 0, 0};
  GrassField field;
  field.region = {{9.5, 9.5}, {10.5, 10.5}};
  field.density = 1;
  field.width = {0.05, 0};
  scene.grass.push_back(field);
  World world = build_world(scene);
  ASSERT_EQ(world.grass.front().size(), 1u);
  Device device;
  const Frame at_padding = FrameRunner(device, world).render(0, 0);
  for (std::size_t i = 0; i < at_padding.pixels(); ++i) ASSERT_TRUE(is_background(at_padding, i));

  world.scene.camera.position = {10, 9.2, 0.3};
  world.scene.camera.target = {10, 10, 0.15};
  FrameRunner runner(device, world);
  const Frame at_blade = runner.render(0, 0);
  std::size_t covered = 0;
  for (std::size_t i = 0; i < at_blade.pixels(); ++i) covered += !is_background(at_blade, i);
  EXPECT_GT(covered, 10u);
  EXPECT_EQ(runner.posed_geometry().owner.size(), 5u) << "the blade's five triangles";
}

}  // namespace
}  // namespace understory
