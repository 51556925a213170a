#include "host/frame/camera_view.hpp"

#include <cmath>

namespace understory {
namespace {

struct CameraAxes {
  glm::dvec3 right, down, forward;
};

CameraAxes camera_axes(const Camera& camera) {
  const glm::dvec3 forward = glm::normalize(camera.target - camera.position);
  // Straight up or down has no horizon: take north as the top of the picture.
  const bool vertical = std::abs(forward.z) > 1 - 1e-9;
  const glm::dvec3 right = glm::normalize(glm::cross(forward, vertical ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1)));
  return {right, glm::cross(forward, right), forward};
}

void store(float (&to)[4], glm::dvec3 from) {
  for (int i = 0; i < 3; ++i) to[i] = static_cast<float>(from[i]);
  to[3] = 0;
}

}  // namespace

CameraView camera_view(const Camera& camera, const ImageSize& image, glm::dvec2 pixel_offset) {
  const CameraAxes axes = camera_axes(camera);
  CameraView view{};
  store(view.right, axes.right);
  store(view.down, axes.down);
  store(view.forward, axes.forward);
  view.focal = static_cast<float>(0.5 * image.height / std::tan(0.5 * camera.vertical_fov));
  view.centre_x = static_cast<float>(0.5 * image.width - pixel_offset.x);
  view.centre_y = static_cast<float>(0.5 * image.height - pixel_offset.y);
  view.near_plane = static_cast<float>(camera.near_plane);
  view.width = image.width;
  view.height = image.height;
  return view;
}

glm::dmat4 world_to_camera(const Camera& camera) {
  const CameraAxes axes = camera_axes(camera);
  const glm::dvec3 rows[3] = {axes.right, -axes.down, -axes.forward};
  glm::dmat4 matrix(1);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) matrix[column][row] = rows[row][column];
    matrix[3][row] = -glm::dot(rows[row], camera.position);
  }
  return matrix;
}

}  // namespace understory
