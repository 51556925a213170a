// What is made for G-buffers that lack it: normals from positions, and the camera of an orthographic image.
#include <gmock/gmock.h>

#include <cmath>

#include "tests/support/temporary_folder.hpp"
#include "tests/viz/synthetic_frame.hpp"
#include "viz/exr/camera_fit.hpp"
#include "viz/exr/gbuffer.hpp"
#include "viz/exr/image.hpp"

namespace understory {
namespace {

/// z(x, y) over the pixels of an orthographic camera that looks down a slanted axis, 8 pixels a metre.
template <typename Height>
ExrImage parallel_image(int width, int height, Height z) {
  const glm::dvec3 right = glm::normalize(glm::dvec3(1, 0.4, 0)), forward = glm::normalize(glm::dvec3(0.2, -0.5, -1));
  const glm::dvec3 across = glm::normalize(right - glm::dot(right, forward) * forward);
  const glm::dvec3 down = glm::cross(forward, across);
  ExrImage image{width, height, {}, {}, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::dvec3 p = glm::dvec3(100, 50, 20) + (x + 0.5 - width / 2.0) / 8 * across +
                           (y + 0.5 - height / 2.0) / 8 * down + z(x, y) * forward;
      for (int axis = 0; axis < 3; ++axis)
        image.floats[std::string("P.") + "XYZ"[axis]].push_back(static_cast<float>(p[axis]));
    }
  return image;
}

TEST(GbufferFallback, SolvesAnOrthographicCamera) {
  const TemporaryFolder folder;
  write_exr(folder / "in.exr", parallel_image(60, 40, [](int x, int y) { return 0.3 * std::sin(x * 0.7) + 0.02 * y; }));
  const Gbuffer read = read_gbuffer(folder / "in.exr");
  EXPECT_EQ(read.frame.vertical_fov, 0);
  EXPECT_NEAR(read.frame.orthographic_height, 5, 1e-3);
  float nearest = 1e9f;
  for (std::size_t i = 0; i < read.frame.pixels(); ++i) {
    const glm::dvec4 seen =
        read.frame.world_to_camera *
        glm::dvec4(read.frame.position[0][i], read.frame.position[1][i], read.frame.position[2][i], 1);
    const int x = static_cast<int>(i) % 60, y = static_cast<int>(i) / 60;
    EXPECT_NEAR(seen.x * 8, x + 0.5 - 30, 0.01);
    EXPECT_NEAR(-seen.y * 8, y + 0.5 - 20, 0.01);
    nearest = std::min(nearest, read.frame.depth[i]);
  }
  EXPECT_NEAR(nearest, 1, 0.05) << "a metre before the nearest";
  EXPECT_THAT(read.notes, testing::Contains(testing::HasSubstr("orthographic: 5 m")));
}

TEST(GbufferFallback, MakesNormalsFromPositions) {
  const TemporaryFolder folder;
  // A plane, and one edge in the middle of it.
  write_exr(folder / "in.exr",
            parallel_image(40, 30, [](int x, int y) { return 0.05 * x + 0.03 * y + (x < 20 ? 0 : 2); }));
  const Gbuffer read = read_gbuffer(folder / "in.exr");
  EXPECT_THAT(read.notes, testing::Contains("normal: none in the file; made from the positions"));
  const auto at = [&](std::size_t i) {
    return glm::dvec3(read.frame.normal[0][i], read.frame.normal[1][i], read.frame.normal[2][i]);
  };
  for (std::size_t i = 0; i < read.frame.pixels(); ++i) {
    EXPECT_GT(glm::dot(at(i), at(0)), 0.9999) << i;
    const glm::dmat4& camera = read.frame.world_to_camera;
    EXPECT_GT(glm::dot(at(i), glm::dvec3(camera[0][2], camera[1][2], camera[2][2])), 0) << "to the viewer";
    EXPECT_EQ(read.frame.validity[i], 0u);
  }
}

TEST(GbufferFallback, OfAPerspectiveFrameAreTheNormals) {
  const TemporaryFolder folder;
  const Frame frame = synthetic_frame(163, 101);
  ExrImage image{frame.width, frame.height, {}, {}, {}};
  for (std::size_t axis = 0; axis < 3; ++axis) image.floats[std::string("P.") + "XYZ"[axis]] = frame.position[axis];
  // Without normals only positions that are not finite tell the background.
  for (std::size_t i = 0; i < frame.pixels(); ++i)
    if (frame.validity[i] & validity::background) image.floats["P.X"][i] = NAN;
  write_exr(folder / "in.exr", image);
  const Gbuffer read = read_gbuffer(folder / "in.exr");
  std::size_t alike = 0, drawn = 0;
  for (std::size_t i = 0; i < frame.pixels(); ++i) {
    if (frame.validity[i] & validity::background) continue;
    double cosine = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      cosine += static_cast<double>(read.frame.normal[axis][i]) * static_cast<double>(frame.normal[axis][i]);
    alike += cosine > 0.98;
    ++drawn;
  }
  EXPECT_GT(alike, drawn * 9 / 10);
  EXPECT_EQ(read.frame.orthographic_height, 0);
}

}  // namespace
}  // namespace understory
