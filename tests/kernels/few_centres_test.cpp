// Small triangles that work-items draw side by side (kernels/shared/few_centres.h): exactly the pixels whose centres
// lie inside or on an edge, in 64-bit integers, whatever shapes share a vector; slivers, points and lines among them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/passes/geometry.hpp"
#include "sim/random.hpp"
#include "tests/support/pose_on_device.hpp"

namespace understory {
namespace {

constexpr int width = 67, height = 45;
constexpr std::uint32_t nothing = 0xffffffffu;
using Point = std::array<float, 4>;
using Triangle = std::array<Point, 3>;

/// At depth 1 m with a focal length of a pixel, so that coordinates are pixels.
CameraView pixel_camera() {
  CameraView camera{};
  camera.right[0] = camera.down[1] = camera.forward[2] = 1;
  camera.focal = 1;
  camera.near_plane = 0.1f;
  camera.width = width;
  camera.height = height;
  return camera;
}

/// Of all shapes, on a grid of 1/512 pixel, every other corner of which snaps; some reach out of the image.
std::vector<Triangle> scattered_triangles(std::uint64_t seed, int count) {
  Random random(11, seed);
  const auto on_grid = [](double x) { return static_cast<float>(std::round(x * 512) / 512); };
  std::vector<Triangle> triangles;
  for (int i = 0; i < count; ++i) {
    const double across = std::exp2(random.uniform(-2, 4.3)), down = std::exp2(random.uniform(-2, 4.3));
    const double x = random.uniform(0, width), y = random.uniform(0, height);
    Triangle triangle;
    for (Point& corner : triangle)
      corner = {on_grid(std::max(0.0, x + across * random.uniform())),
                on_grid(std::max(0.0, y + down * random.uniform())), 1, 0};
    if (i % 9 == 0) triangle[2] = triangle[1];                              // a line
    if (i % 11 == 0) triangle[2] = {triangle[0][0], triangle[1][1], 1, 0};  // edges along rows and columns
    if (i % 7 == 0)                                                         // corners on pixel centres
      for (Point& corner : triangle) corner = {std::floor(corner[0]) + 0.5f, std::floor(corner[1]) + 0.5f, 1, 0};
    triangles.push_back(triangle);
  }
  return triangles;
}

/// Whether the centre of pixel (x, y) lies in or on a triangle whose corners snap to 1/256 pixel; one without area
/// covers nothing.
bool covers(const Triangle& triangle, int x, int y) {
  std::int64_t cx[3], cy[3];
  for (std::size_t k = 0; k < 3; ++k) {
    cx[k] = static_cast<std::int64_t>(std::floor(double(triangle[k][0]) * 256 + 0.5));
    cy[k] = static_cast<std::int64_t>(std::floor(double(triangle[k][1]) * 256 + 0.5));
  }
  const std::int64_t px = 256 * x + 128, py = 256 * y + 128;
  std::int64_t edges[3], area = 0;
  for (int k = 0; k < 3; ++k) {
    const int l = (k + 1) % 3;
    edges[k] = (cx[l] - cx[k]) * (py - cy[k]) - (cy[l] - cy[k]) * (px - cx[k]);
    area += edges[k];  // twice the area, whichever point is asked for
  }
  if (area == 0) return false;
  const bool all_left = edges[0] >= 0 && edges[1] >= 0 && edges[2] >= 0;
  const bool all_right = edges[0] <= 0 && edges[1] <= 0 && edges[2] <= 0;
  return all_left || all_right;
}

/// All have the same depth, at which the lowest number wins.
std::vector<std::uint32_t> expected_pixels(const std::vector<Triangle>& triangles) {
  std::vector<std::uint32_t> seen(std::size_t{width} * height, nothing);
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        std::uint32_t& pixel = seen[static_cast<std::size_t>(y * width + x)];
        if (pixel == nothing && covers(triangles[t], x, y)) pixel = t;
      }
  return seen;
}

std::vector<std::uint32_t> drawn_pixels(Device& device, const std::vector<Triangle>& triangles, int lanes) {
  std::vector<Point> corners;
  std::vector<std::uint32_t> index[3];
  for (const Triangle& triangle : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      index[k].push_back(static_cast<std::uint32_t>(corners.size()));
      corners.push_back(triangle[k]);
    }
  for (auto& plane : index) plane.resize(triangles_per_chunk, 0);
  const std::vector<TriangleChunk> chunks{{0, 0, static_cast<std::uint32_t>(triangles.size()), 1}};
  const std::size_t pixels = std::size_t{width} * height, local = triangles_per_chunk / static_cast<std::size_t>(lanes);
  Buffer<std::uint32_t> words(device, 2 * pixels, "visible");
  const auto a = upload_test_data(device, index[0]), b = upload_test_data(device, index[1]),
             c = upload_test_data(device, index[2]);
  for (int pass = 0; pass < 2; ++pass) {
    const std::string options =
        "-DW=" + std::to_string(lanes) + " -DNARROW_ATOMICS -DRASTER_PASS=" + std::to_string(pass);
    const auto count = static_cast<std::uint32_t>(2 * pixels);
    if (pass == 0)
      Kernel(device, "rasterise", "clear_visible", "clear_visible", options).launch(count, 256, words, count);
    Kernel(device, "rasterise", "rasterise_mesh", "rasterise_mesh", options)
        .launch(local, local, upload_test_data(device, chunks), a, b, c, upload_test_data(device, corners),
                pixel_camera(), words);
  }
  const std::vector<std::uint32_t> both = words.read();
  return {both.begin() + static_cast<std::ptrdiff_t>(pixels), both.end()};
}

TEST(FewCentres, AreThoseInsideOrOnAnEdge) {
  Device device;
  std::size_t covered = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const std::vector<Triangle> triangles = scattered_triangles(seed, 241);
    const std::vector<std::uint32_t> expected = expected_pixels(triangles);
    covered += expected.size() - static_cast<std::size_t>(std::count(expected.begin(), expected.end(), nothing));
    for (const int lanes : vector_widths)
      ASSERT_EQ(drawn_pixels(device, triangles, lanes), expected) << "W = " << lanes << ", seed " << seed;
  }
  EXPECT_GT(covered, 2000u) << "the triangles cover something";
}

TEST(FewCentres, EachShapeAloneInItsVector) {
  Device device;
  for (int across = 1; across <= 20; ++across)
    for (int down : {1, 2, 3, 16, 17, 20}) {
      const auto right = static_cast<float>(3 + across), bottom = static_cast<float>(2 + down);
      const std::vector<Triangle> one{{Point{3, 2, 1, 0}, Point{right, 2.25f, 1, 0}, Point{3.5f, bottom, 1, 0}}};
      ASSERT_EQ(drawn_pixels(device, one, 16), expected_pixels(one)) << across << " x " << down;
    }
}

}  // namespace
}  // namespace understory
