// The camera behind a position buffer: every pixel says where its scene point is seen, so a pinhole can be solved for.
// Direct linear transformation (Hartley and Zisserman, Multiple View Geometry, 2nd ed., sections 7.1 and 6.2.4).
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "sim/frame.hpp"

namespace understory {

struct FittedCamera {
  glm::dmat4 world_to_camera{1};  // as in Frame
  double vertical_fov = 0;        // radians
  double error_pixels = 0;        // largest distance of a reprojected point from its pixel's centre, over the samples
  double off_centre_pixels = 0;   // how far the principal point is from the image's middle
};

/// From the pixels with `valid` != 0, at their centres. Empty when they determine no perspective camera: fewer than
/// six, all on one plane, or seen from infinitely far.
std::optional<FittedCamera> fit_camera(int width, int height, const std::array<Plane, 3>& position,
                                       const std::vector<std::uint8_t>& valid);

struct ParallelCamera {
  glm::dmat4 world_to_camera{1};  // as in Frame, a metre before the nearest point
  double height = 0;              // m from the top to the bottom of the image
  double error_pixels = 0;        // as FittedCamera
};

/// The same for an orthographic camera with square pixels. Empty when the positions determine none within half a pixel.
/// A wall that faces a perspective camera looks the same to it.
std::optional<ParallelCamera> fit_parallel_camera(int width, int height, const std::array<Plane, 3>& position,
                                                  const std::vector<std::uint8_t>& valid);

/// Where a frame's camera sees a point, in pixels from the upper left corner.
glm::dvec2 project(const Frame& frame, glm::dvec3 point);

}  // namespace understory
