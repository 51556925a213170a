// rasterise and resolve against rays in double: coverage, depth, cracks, clipping, both buffer layouts.
#include <gtest/gtest.h>

#include <cmath>

#include "host/frame/camera_view.hpp"
#include "host/frame/geometry.hpp"
#include "host/passes/pose_mesh.hpp"
#include "host/passes/rasterise.hpp"
#include "host/passes/resolve.hpp"
#include "sim/random.hpp"
#include "tests/reference/rasterise.hpp"
#include "tests/support/meshes.hpp"

namespace understory {
namespace {

struct Picture {
  CameraView camera{};
  std::vector<std::uint32_t> owner;
  std::vector<float> depth, x, y, z, nx, ny, nz;
  bool covered(std::size_t i) const { return owner[i] != 0; }
};

/// Poses, rasterises and resolves triangles as the frame runner does. The eye is at the origin.
Picture draw(const std::vector<glm::vec3>& vertices, const std::vector<std::uint32_t>& triangles, const Camera& camera,
             ImageSize image, bool wide_atomics) {
  Device device;
  const World world = world_of_triangles(vertices, triangles);
  Geometry geometry = upload_geometry(device, world);
  const std::vector<LimbPose> limb = {standing_limb(glm::vec3(camera.position))};
  PoseMeshPass(device).run(geometry.rest, geometry.blocks,
                           Buffer<LimbPose>(device, std::span<const LimbPose>(limb), "limb"), geometry.posed);
  Picture picture;
  picture.camera = camera_view(camera, image, glm::dvec2(0));
  const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  VisibilityBuffer visible{Buffer<std::uint32_t>(device, 2 * pixels, "visible")};
  RasterisePass(device, true, false, wide_atomics).run(geometry.triangles, geometry.posed, picture.camera, visible);
  FragmentPlanes planes =
      allocate_planes(device, static_cast<std::size_t>(image.width), static_cast<std::size_t>(image.height), false);
  ResolvePass(device, {}, wide_atomics)
      .run(visible, geometry.triangles, geometry.posed, {geometry.blades}, picture.camera, planes);
  picture.owner = planes.owner.read();
  picture.depth = planes.depth.read();
  picture.x = planes.position_x.read(), picture.y = planes.position_y.read(), picture.z = planes.position_z.read();
  picture.nx = planes.normal_x.read(), picture.ny = planes.normal_y.read(), picture.nz = planes.normal_z.read();
  return picture;
}

bool wide_atomics_present() { return Device().info().atomic64; }

std::vector<glm::dvec3> relative(const std::vector<glm::vec3>& vertices, glm::dvec3 eye) {
  std::vector<glm::dvec3> all;
  for (const glm::vec3& v : vertices) all.push_back(glm::dvec3(v) - eye);
  return all;
}

Camera level_camera() {
  Camera camera;
  camera.position = {0, 0, 0};
  camera.target = {0, 1, 0};
  camera.vertical_fov = 0.9;
  camera.near_plane = 0.1;
  return camera;
}

TEST(Rasterise, SeesWhatRaysSee) {
  // Triangles of all sizes, many smaller than a pixel, some behind the eye, some through the near plane.
  Random random(7, 1);
  std::vector<glm::vec3> vertices;
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t i = 0; i < 1003; ++i) {
    const glm::dvec3 centre(random.uniform(-6, 6), random.uniform(-1, 12), random.uniform(-5, 5));
    const double size = std::pow(10.0, random.uniform(-2.5, 0.3));
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      vertices.push_back(glm::vec3(centre + size * glm::dvec3(random.normal(), random.normal(), random.normal())));
      triangles.push_back(3 * i + corner);
    }
  }
  const Camera camera = level_camera();
  const ImageSize image{61, 43};
  const Picture picture = draw(vertices, triangles, camera, image, wide_atomics_present());
  const std::vector<glm::dvec3> seen_from_eye = relative(vertices, camera.position);
  int different = 0, covered = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const auto i = static_cast<std::size_t>(y * image.width + x);
      const reference::Hit hit = reference::trace_pixel(picture.camera, seen_from_eye, triangles, x, y);
      const bool hit_any = hit.triangle != 0xffffffffu;
      covered += hit_any;
      if (hit_any != picture.covered(i)) {
        ++different;
        continue;
      }
      if (!hit_any) continue;
      if (std::abs(picture.depth[i] - hit.depth) > 1e-4 * hit.depth) {
        ++different;
        continue;
      }
      EXPECT_NEAR(picture.nx[i] * picture.nx[i] + picture.ny[i] * picture.ny[i] + picture.nz[i] * picture.nz[i], 1,
                  1e-5);
      const glm::dvec3 ray = reference::pixel_ray(picture.camera, x, y);
      EXPECT_LE(picture.nx[i] * ray.x + picture.ny[i] * ray.y + picture.nz[i] * ray.z, 1e-6) << "faces away";
      EXPECT_NEAR(picture.x[i], ray.x * picture.depth[i], 1e-4);
    }
  EXPECT_GT(covered, image.width * image.height / 2);
  // Samples within 1/256 pixel of an edge may fall on either side of it: corners snap to that raster.
  EXPECT_LE(different, covered / 100);
}

TEST(Rasterise, LeavesNoCrackBetweenNeighbours) {
  // A jittered mesh that fills the view: every pixel is covered, at the depth of the plane.
  Random random(11, 2);
  const std::uint32_t n = 41;
  std::vector<glm::vec3> vertices;
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t row = 0; row < n; ++row)
    for (std::uint32_t column = 0; column < n; ++column) {
      const bool inner = row > 0 && column > 0 && row + 1 < n && column + 1 < n;
      const double jitter = inner ? 0.3 : 0;
      vertices.push_back(
          glm::vec3(column - 20.0 + random.uniform(-jitter, jitter), 8, row - 20.0 + random.uniform(-jitter, jitter)));
    }
  for (std::uint32_t row = 0; row + 1 < n; ++row)
    for (std::uint32_t column = 0; column + 1 < n; ++column) {
      const std::uint32_t v = row * n + column;
      triangles.insert(triangles.end(), {v, v + 1, v + n, v + 1, v + n, v + n + 1});  // both windings
    }
  for (const bool wide : {true, false}) {
    if (wide && !wide_atomics_present()) continue;
    const Picture picture = draw(vertices, triangles, level_camera(), {317, 211}, wide);
    for (std::size_t i = 0; i < 317 * 211; ++i) {
      ASSERT_TRUE(picture.covered(i)) << "crack at " << i % 317 << ", " << i / 317;
      ASSERT_NEAR(picture.depth[i], 8, 1e-4);
    }
  }
}

TEST(Rasterise, ClipsGroundThatPassesUnderTheEye) {
  // One huge quad from far behind to far ahead: everything below the horizon is ground at its exact depth.
  const std::vector<glm::vec3> vertices = {
      {-3000, -3000, -1.5f}, {3000, -3000, -1.5f}, {3000, 3000, -1.5f}, {-3000, 3000, -1.5f}};
  const Camera camera = level_camera();
  const Picture picture = draw(vertices, {0, 1, 2, 0, 2, 3}, camera, {160, 100}, wide_atomics_present());
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 160; ++x) {
      const auto i = static_cast<std::size_t>(y * 160 + x);
      const glm::dvec3 ray = reference::pixel_ray(picture.camera, x, y);
      const double depth = -1.5 / ray.z;  // forward component 1
      const bool ground = ray.z < 0 && depth < 3000 && std::abs(ray.x) * depth < 3000;
      ASSERT_EQ(picture.covered(i), ground) << x << ", " << y;
      if (!ground) continue;
      EXPECT_NEAR(picture.depth[i], depth, 1e-3 * depth);
      EXPECT_NEAR(picture.z[i], -1.5, 2e-3 * depth);
      EXPECT_NEAR(picture.nz[i], 1, 1e-5);
    }
}

TEST(Rasterise, BothBufferLayoutsGiveTheSamePixels) {
  if (!wide_atomics_present()) GTEST_SKIP() << "this device has no 64-bit atomics: there is only one layout to test";
  Random random(3, 3);
  std::vector<glm::vec3> vertices;
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t i = 0; i < 3 * 700; ++i) {
    vertices.push_back(glm::vec3(random.uniform(-3, 3), random.uniform(2, 9), random.uniform(-3, 3)));
    triangles.push_back(i);
  }
  const Picture wide = draw(vertices, triangles, level_camera(), {123, 77}, true);
  const Picture narrow = draw(vertices, triangles, level_camera(), {123, 77}, false);
  EXPECT_EQ(wide.depth, narrow.depth);
  EXPECT_EQ(wide.nx, narrow.nx);
  EXPECT_EQ(wide.owner, narrow.owner);
}

TEST(Rasterise, NothingInViewLeavesBackground) {
  const Picture picture =
      draw({{0, -5, 0}, {1, -5, 0}, {0, -5, 1}}, {0, 1, 2}, level_camera(), {17, 13}, wide_atomics_present());
  for (std::size_t i = 0; i < 17 * 13; ++i) {
    EXPECT_FALSE(picture.covered(i));
    EXPECT_TRUE(std::isinf(picture.depth[i]));
  }
}

}  // namespace
}  // namespace understory
