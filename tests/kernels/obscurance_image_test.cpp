// What surrounds obscurance: the edge-aware blur, half resolution and back, normals made from depth.
#include <gtest/gtest.h>

#include "host/passes/normals_from_depth.hpp"
#include "host/passes/obscurance_blur.hpp"
#include "host/passes/obscurance_half.hpp"
#include "tests/support/depth_images.hpp"

namespace understory {
namespace {

/// Visibility that varies from pixel to pixel with the rotation pattern, around a mean of one half.
std::vector<float> patterned(const ObscuranceView& view, std::size_t padded) {
  std::vector<float> values(padded, NAN);
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x)
      values[static_cast<std::size_t>(y * view.width + x)] =
          static_cast<float>(0.5 + 0.4 * (reference::pattern_turn(x, y) + 1.0 / 32));
  return values;
}

Shaded blur(const reference::DepthImage& image, int radius, double reach) {
  return shade_image(image, [&](Device& device, int lanes, FragmentPlanes& planes, Buffer<float>& visibility) {
    visibility.write(patterned(image.view, planes.padded_fragments));
    Buffer<float> scratch(device, planes.padded_fragments, "scratch");
    ObscuranceBlurPass(device, lanes).run(planes, image.view, radius, reach, visibility, scratch);
  });
}

float at(const Shaded& shaded, const ObscuranceView& view, int x, int y) {
  return shaded.visibility[static_cast<std::size_t>(y * view.width + x)];
}

TEST(ObscuranceBlur, EvensOutTheRotationPatternOnATiltedPlane) {
  UNDERSTORY_NEEDS_DEVICE();
  for (const double field_of_view : {0.8, 0.0}) {
    const ObscuranceView view = odd_view(37, 29, field_of_view);
    const Shaded shaded =
        blur(image_of(view, plane_surface({0, 0, 5}, glm::normalize(glm::dvec3(1, 0.5, -1.5)))), 4, 0.1);
    for (int y = 4; y < 25; ++y)
      for (int x = 4; x < 33; ++x)
        if (at(shaded, view, x, y) != 1) {
          EXPECT_NEAR(at(shaded, view, x, y), 0.5, 5e-4) << x << ' ' << y;
        }
  }
}

TEST(ObscuranceBlur, StopsAtEdgesOfDepthAndOfNormals) {
  UNDERSTORY_NEEDS_DEVICE();
  const ObscuranceView view = odd_view(35, 19, 0);
  const glm::dvec3 left = glm::normalize(glm::dvec3(1, 0, -1)), right = glm::normalize(glm::dvec3(-1, 0, -1));
  for (const bool step : {true, false}) {
    const reference::DepthImage image = image_of(view, [&](const reference::PixelRay& ray) {
      if (step) return SurfacePoint{ray.origin.x > 0 ? 3.0 : 4.0, {0, 0, -1}};
      return SurfacePoint{4 + std::abs(ray.origin.x), ray.origin.x > 0 ? right : left};
    });
    const Shaded shaded = shade_image(image, [&](Device& device, int lanes, FragmentPlanes& planes, Buffer<float>& v) {
      std::vector<float> sides(planes.padded_fragments, 0.5f);
      for (std::size_t i = 0; i < planes.fragments; ++i)
        sides[i] = reference::pixel_ray(view, static_cast<int>(i % 35), 0).origin.x > 0 ? 1.0f : 0.0f;
      v.write(sides);
      Buffer<float> scratch(device, planes.padded_fragments, "scratch");
      ObscuranceBlurPass(device, lanes).run(planes, view, 6, 0.2, v, scratch);
    });
    for (int x = 0; x < 35; ++x)
      EXPECT_NEAR(at(shaded, view, x, 9), reference::pixel_ray(view, x, 9).origin.x > 0 ? 1 : 0, 1e-6) << x;
  }
}

TEST(ObscuranceHalf, ComesBackOnPlanesAndStopsAtEdges) {
  UNDERSTORY_NEEDS_DEVICE();
  for (const glm::ivec2 size : {glm::ivec2(37, 22), glm::ivec2(1, 1), glm::ivec2(2, 3)}) {
    const ObscuranceView view = odd_view(size.x, size.y, 0.9);
    const glm::dvec3 slanted = glm::normalize(glm::dvec3(0.5, 0.5, -1));
    const reference::DepthImage image = image_of(view, [&](const reference::PixelRay& ray) {
      return plane_surface({0, 0, ray.direction.x > 0.02 ? 3 : 6}, slanted)(ray);
    });
    const Shaded shaded = shade_image(image, [&](Device& device, int lanes, FragmentPlanes& planes, Buffer<float>& v) {
      const ObscuranceView small = half_view(view);
      FragmentPlanes half =
          allocate_planes(device, static_cast<std::size_t>(small.width), static_cast<std::size_t>(small.height), false);
      ObscuranceHalfPass(device).run(planes, view, half);
      std::vector<float> sides(half.padded_fragments, 0.0f);
      std::vector<std::uint32_t> codes = half.validity.read();
      for (std::size_t i = 0; i < half.fragments; ++i) {
        const int x = static_cast<int>(i) % small.width, y = static_cast<int>(i) / small.width;
        const bool near = reference::pixel_ray(view, 2 * x, 2 * y).direction.x > 0.02;
        sides[i] = near ? 1.0f : 0.25f;
        if (near) codes[i] |= validity::left_image;
      }
      half.validity.write(codes);
      Buffer<float> small_visibility(device, std::span<const float>(sides), "small");
      ObscuranceUpsamplePass(device, lanes).run(half, small_visibility, 0.1, planes, view, v);
    });
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x + 1 < size.x; ++x) {
        const bool near = reference::pixel_ray(view, x, y).direction.x > 0.02;
        // A column between two surfaces takes the nearer one where its own has no small pixel.
        if (near != (reference::pixel_ray(view, x + 1, y).direction.x > 0.02)) continue;
        EXPECT_NEAR(at(shaded, view, x, y), near ? 1 : 0.25, 1e-5) << x << ' ' << y;
      }
  }
}

TEST(NormalsFromDepth, ArePlanesNormals) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  for (const double field_of_view : {1.2, 0.0}) {
    const ObscuranceView view = odd_view(33, 21, field_of_view);
    const glm::dvec3 left = glm::normalize(glm::dvec3(0.7, 0.2, -1)), right = glm::normalize(glm::dvec3(-0.3, 0.6, -1));
    const reference::DepthImage image = image_of(view, [&](const reference::PixelRay& ray) {
      const bool first = (view.perspective ? ray.direction.x : ray.origin.x) < 0;
      return plane_surface({0, 0, first ? 4 : 6}, first ? left : right)(ray);
    });
    const FragmentPlanes planes = upload_image(device, image);
    Buffer<float> x(device, planes.padded_fragments, "x"), y(device, planes.padded_fragments, "y"),
        z(device, planes.padded_fragments, "z");
    NormalsFromDepthPass(device).run(planes, view, x, y, z);
    const std::vector<float> made[3] = {x.read(), y.read(), z.read()};
    const std::vector<float> exact[3] = {planes.normal_x.read(), planes.normal_y.read(), planes.normal_z.read()};
    for (std::size_t i = 0; i < planes.fragments; ++i) {
      if (std::isinf(image.depth[i])) continue;
      for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(made[axis][i], exact[axis][i], 1e-3) << i;
    }
  }
}

TEST(NormalsFromDepth, OfASinglePixelFaceTheViewer) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  const ObscuranceView view = odd_view(3, 3, 1.0);
  int pixel = 0;
  const reference::DepthImage image = image_of(view, [&](const reference::PixelRay&) {
    return pixel++ == 4 ? SurfacePoint{2, {0, 0, -1}} : SurfacePoint{};
  });
  const FragmentPlanes planes = upload_image(device, image);
  Buffer<float> x(device, planes.padded_fragments, "x"), y(device, planes.padded_fragments, "y"),
      z(device, planes.padded_fragments, "z");
  NormalsFromDepthPass(device).run(planes, view, x, y, z);
  const glm::dvec3 ray = glm::normalize(reference::pixel_ray(view, 1, 1).direction);
  const glm::vec3 world = float(ray.x) * view.right + float(ray.y) * view.down + float(ray.z) * view.forward;
  EXPECT_NEAR(glm::dot(world, glm::vec3(x.read()[4], y.read()[4], z.read()[4])), -1, 1e-5);
  EXPECT_EQ(x.read()[0], 0);
}

}  // namespace
}  // namespace understory
