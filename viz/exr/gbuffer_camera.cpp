// Header matrices and the solved camera, weighed against each other.
#include "viz/exr/gbuffer_camera.hpp"

#include <fmt/format.h>

#include <glm/gtc/matrix_transform.hpp>
#include <optional>
#include <string>

#include "sim/error.hpp"
#include "viz/exr/camera_fit.hpp"
#include "viz/exr/header_camera.hpp"

namespace understory {
namespace {

void apply(const glm::dmat4& transform, double w, std::array<Plane, 3>& planes) {
  for (std::size_t i = 0; i < planes[0].size(); ++i) {
    const glm::dvec4 v = transform * glm::dvec4(planes[0][i], planes[1][i], planes[2][i], w);
    for (int axis = 0; axis < 3; ++axis) planes[static_cast<std::size_t>(axis)][i] = static_cast<float>(v[axis]);
  }
}

/// Positions relative to the camera let the solved eye lie at the zero while the header puts it elsewhere.
bool is_camera_space(const glm::dmat4& header_camera, const std::optional<FittedCamera>& fit) {
  if (!fit) return false;
  const glm::dvec3 solved = eye_of(fit->world_to_camera), told = eye_of(header_camera);
  return glm::length(solved) < 0.1 * glm::length(told - solved);
}

glm::dmat4 look_at(const Camera& camera) {
  const glm::dvec3 view = camera.target - camera.position;
  const bool vertical = glm::length(glm::dvec2(view)) < 1e-6 * glm::length(view);
  return glm::lookAt(camera.position, camera.target, vertical ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1));
}

void tell_fit(const FittedCamera& fit, std::vector<std::string>& notes) {
  if (fit.error_pixels > 0.5)
    notes.push_back(
        fmt::format("warning: positions lie up to {:.2f} pixels from the pixels that show them; "
                    "were they filtered or is it no pinhole camera?",
                    fit.error_pixels));
  if (fit.off_centre_pixels > 1)
    notes.push_back(
        fmt::format("warning: the optical axis is {:.1f} pixels off the image's middle; "
                    "the field of view told is about the middle",
                    fit.off_centre_pixels));
}

}  // namespace

void settle_camera(const ExrHeader& header, const GbufferOptions& options, const std::vector<std::uint8_t>& surface,
                   GbufferPlanes& planes, Gbuffer& result) {
  Frame& frame = result.frame;
  const auto told = camera_from_header(header.attributes);
  const auto fit = fit_camera(frame.width, frame.height, planes.position, surface);
  const auto parallel = fit ? std::nullopt : fit_parallel_camera(frame.width, frame.height, planes.position, surface);
  const bool camera_space =
      options.space == GbufferSpace::camera ||
      (options.space == GbufferSpace::automatic && told.has_value() && is_camera_space(told->world_to_camera, fit));
  if (fit) {
    frame.vertical_fov = fit->vertical_fov;
    tell_fit(*fit, result.notes);
  }
  if (parallel) {
    frame.orthographic_height = parallel->height;
    result.notes.push_back(
        fmt::format("orthographic: {:.4g} m from top to bottom, solved from positions within {:.3f} "
                    "pixels",
                    parallel->height, parallel->error_pixels));
  }
  if (told) {
    frame.world_to_camera = told->world_to_camera;
    result.notes.push_back(fmt::format("camera: header worldToCamera{}", told->transposed ? " (column vectors)" : ""));
  } else if (options.camera) {
    frame.world_to_camera = look_at(*options.camera);
    frame.vertical_fov = options.camera->vertical_fov;
    frame.orthographic_height = 0;
    result.notes.push_back("camera: as given");
  } else if (fit) {
    frame.world_to_camera = fit->world_to_camera;
    result.notes.push_back(fmt::format("camera: solved from positions, within {:.3f} pixels", fit->error_pixels));
  } else if (parallel) {
    frame.world_to_camera = parallel->world_to_camera;
    result.notes.push_back("camera: orthographic, solved from positions, a metre before the nearest");
  } else {
    throw Error(ErrorKind::invalid_input,
                "no camera in the header, and positions that are few, flat or seen from infinity determine none; "
                "give one with --camera");
  }
  if (!camera_space) return void(result.notes.push_back("space: world"));
  if (!told && !options.camera)
    throw Error(ErrorKind::invalid_input, "positions in camera space need a camera: none in the header and none given");
  // Files in camera space use the header's axes: +z forward.
  glm::dmat4 to_world = glm::inverse(frame.world_to_camera);
  to_world[2] *= -1.0;
  apply(to_world, 1, planes.position);
  apply(to_world, 0, planes.normal);
  result.notes.push_back("space: camera, moved to the world");
}

glm::dvec3 eye_of(const glm::dmat4& world_to_camera) { return glm::dvec3(glm::inverse(world_to_camera)[3]); }

}  // namespace understory
