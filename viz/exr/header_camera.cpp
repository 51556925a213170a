// The standard says row vectors (translation in the last row); pbrt-v4 writes the matrix for column vectors.
// The row or column that is (0, 0, 0, 1) tells them apart. Both look along +z with x right and y up (left-handed).
#include "viz/exr/header_camera.hpp"

#include <cmath>

#include "sim/error.hpp"

namespace understory {
namespace {

bool is_affine_end(glm::dvec4 v) {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z) < 1e-6 && std::abs(v.w - 1) < 1e-6;
}

bool is_rigid(const glm::dmat4& matrix) {
  const glm::dmat3 rotation(matrix);
  const glm::dmat3 product = glm::transpose(rotation) * rotation;
  double error = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) error = std::max(error, std::abs(product[i][j] - (i == j ? 1.0 : 0.0)));
  return error < 1e-3;  // NaN fails
}

}  // namespace

std::optional<HeaderCamera> camera_from_header(const ExrAttributeTable& attributes) {
  const auto at = attributes.matrices.find("worldToCamera");
  if (at == attributes.matrices.end()) return std::nullopt;
  glm::dmat4 matrix = at->second;  // GLM's columns are the header's rows
  HeaderCamera camera;
  const glm::dmat4 turned = glm::transpose(matrix);
  if (!is_affine_end(turned[3])) {
    camera.transposed = true;
    matrix = turned;
    if (!is_affine_end(at->second[3]))
      throw Error(ErrorKind::invalid_input,
                  "header attribute worldToCamera: neither its last row nor its last column is (0, 0, 0, 1)");
  }
  if (!is_rigid(matrix))
    throw Error(ErrorKind::invalid_input, "header attribute worldToCamera: not a rotation and a translation");
  for (int column = 0; column < 4; ++column) matrix[column].z *= -1;
  camera.world_to_camera = matrix;
  return camera;
}

}  // namespace understory
