// Depth images for the tests of obscurance: planes, edges and bumps as some camera sees them. No test framework
// (test_fragments.hpp).
#pragma once
#include <cmath>
#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <vector>

#include "tests/reference/obscurance.hpp"
#include "tests/support/test_fragments.hpp"

namespace understory {

inline constexpr double infinitely_far = std::numeric_limits<double>::infinity();

/// A camera turned in an odd way; `field_of_view`: vertical, radians; 0: orthographic, 20 pixels a metre.
inline ObscuranceView odd_view(int width, int height, double field_of_view) {
  const glm::mat3 turn = glm::mat3_cast(glm::angleAxis(2.1f, glm::normalize(glm::vec3(1, -2, 0.5f))));
  ObscuranceView view;
  view.right = turn[0];
  view.down = turn[1];
  view.forward = turn[2];
  view.width = width;
  view.height = height;
  view.centre_x = 0.5 * width + 0.3;
  view.centre_y = 0.5 * height - 0.2;
  view.perspective = field_of_view > 0;
  view.focal = view.perspective ? 0.5 * height / std::tan(0.5 * field_of_view) : 20;
  return view;
}

/// `surface`: depth (camera z, m) and normal (camera axes, towards the viewer) that a pixel's ray meets.
struct SurfacePoint {
  double depth = infinitely_far;
  glm::dvec3 normal{0, 0, -1};
};
using Surface = std::function<SurfacePoint(const reference::PixelRay&)>;

/// Depth is what float holds, so that the reference sees the same image.
inline reference::DepthImage image_of(const ObscuranceView& view, const Surface& surface) {
  reference::DepthImage image{view, {}, {}};
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      const SurfacePoint point = surface(reference::pixel_ray(view, x, y));
      image.depth.push_back(static_cast<double>(static_cast<float>(point.depth)));
      image.normal.push_back(point.normal);
    }
  return image;
}

/// The plane through `point`; behind the camera or its horizon there is background.
inline Surface plane_surface(glm::dvec3 point, glm::dvec3 normal) {
  return [=](const reference::PixelRay& ray) {
    const double facing = glm::dot(normal, ray.direction);
    const double depth = glm::dot(point - ray.origin, normal) / facing;
    return facing < -1e-2 && depth > 1e-3 ? SurfacePoint{depth, normal} : SurfacePoint{};
  };
}

/// Patches of many depths and normals with sharp edges between them, and background here and there.
inline Surface patchwork(std::uint64_t seed, double depth, double relief) {
  return [=](const reference::PixelRay& ray) {
    const glm::dvec3 p = ray.at(depth);
    const auto cell = [&](double v) { return static_cast<std::uint64_t>(std::floor(v / relief * 2) + 1000); };
    Random random(seed, cell(p.x), cell(p.y));
    if (random.uniform() < 0.1) return SurfacePoint{};
    SurfacePoint point;
    point.depth = depth + relief * random.uniform(-1, 1) + 0.3 * relief * std::sin(7 * p.x / relief);
    point.normal = glm::normalize(glm::dvec3(random.uniform(-0.8, 0.8), random.uniform(-0.8, 0.8), 0) -
                                  glm::normalize(ray.direction));
    if (glm::dot(point.normal, ray.direction) > 0) point.normal = -point.normal;
    return point;
  };
}

inline FragmentPlanes upload_image(Device& device, const reference::DepthImage& image) {
  const auto width = static_cast<std::size_t>(image.view.width), height = static_cast<std::size_t>(image.view.height);
  FragmentPlanes planes = allocate_planes(device, width, height, false);
  std::vector<float> depth(planes.padded_fragments, NAN), normal[3];
  for (std::vector<float>& axis : normal) axis.assign(planes.padded_fragments, INFINITY);
  std::vector<std::uint32_t> flags(planes.padded_fragments, 0);
  for (std::size_t i = 0; i < planes.fragments; ++i) {
    depth[i] = static_cast<float>(image.depth[i]);
    const glm::vec3 n(image.normal[i]);
    const glm::vec3 world = n.x * image.view.right + n.y * image.view.down + n.z * image.view.forward;
    for (int axis = 0; axis < 3; ++axis) normal[axis][i] = world[axis];
    if (std::isinf(depth[i])) flags[i] = validity::background;
  }
  planes.depth.write(depth);
  planes.normal_x.write(normal[0]);
  planes.normal_y.write(normal[1]);
  planes.normal_z.write(normal[2]);
  planes.validity.write(flags);
  return planes;
}

}  // namespace understory
