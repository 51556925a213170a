// Direct linear transformation with normalised data, then the camera's parts from the matrix.
#include "viz/exr/camera_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace understory {
namespace {

constexpr std::size_t largest_sample_count = 4096;

struct Sample {
  glm::dvec3 point;
  glm::dvec2 pixel;
};

std::vector<Sample> take_samples(int width, int height, const std::array<Plane, 3>& position,
                                 const std::vector<std::uint8_t>& valid) {
  const auto count = static_cast<std::size_t>(std::count_if(valid.begin(), valid.end(), [](auto v) { return v != 0; }));
  const std::size_t step = std::max<std::size_t>(1, count / largest_sample_count);
  std::vector<Sample> samples;
  std::size_t seen = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      if (valid[i] == 0 || seen++ % step != 0) continue;
      samples.push_back({{position[0][i], position[1][i], position[2][i]}, {x + 0.5, y + 0.5}});
    }
  return samples;
}

/// Rows of the 3 x 4 projection P in pixels, column vectors; empty when the points do not determine it.
/// P's bottom row is scaled so that the centroid has depth 1, which every point in front of a camera allows.
std::optional<Eigen::Matrix<double, 3, 4>> solve_projection(const std::vector<Sample>& samples, glm::dvec2 middle) {
  glm::dvec3 centroid(0);
  for (const Sample& sample : samples) centroid += sample.point / static_cast<double>(samples.size());
  double spread = 0;
  for (const Sample& sample : samples)
    spread += glm::length(sample.point - centroid) / static_cast<double>(samples.size());
  if (!(spread > 0) || !std::isfinite(spread)) return std::nullopt;

  const double pixel_scale = middle.x + middle.y;
  Eigen::MatrixXd equations(2 * static_cast<Eigen::Index>(samples.size()), 11);
  Eigen::VectorXd right_side(equations.rows());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const glm::dvec3 p = (samples[i].point - centroid) / spread;
    const glm::dvec2 q = (samples[i].pixel - middle) / pixel_scale;
    const auto row = 2 * static_cast<Eigen::Index>(i);
    equations.row(row) << p.x, p.y, p.z, 1, 0, 0, 0, 0, -q.x * p.x, -q.x * p.y, -q.x * p.z;
    equations.row(row + 1) << 0, 0, 0, 0, p.x, p.y, p.z, 1, -q.y * p.x, -q.y * p.y, -q.y * p.z;
    right_side[row] = q.x;
    right_side[row + 1] = q.y;
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> decomposition(equations);
  decomposition.setThreshold(1e-6);  // single-precision positions leave about 1e-7 in a flat scene
  if (decomposition.rank() < 11) return std::nullopt;
  const Eigen::VectorXd solution = decomposition.solve(right_side);

  Eigen::Matrix<double, 3, 4> projection;
  projection << solution[0], solution[1], solution[2], solution[3], solution[4], solution[5], solution[6], solution[7],
      solution[8], solution[9], solution[10], 1;
  Eigen::Matrix3d to_pixels;
  to_pixels << pixel_scale, 0, middle.x, 0, pixel_scale, middle.y, 0, 0, 1;
  Eigen::Matrix4d to_centred = Eigen::Matrix4d::Identity();
  to_centred.topLeftCorner<3, 3>() /= spread;
  to_centred.topRightCorner<3, 1>() = -Eigen::Vector3d(centroid.x, centroid.y, centroid.z) / spread;
  return to_pixels * projection * to_centred;
}

/// P = s K [R | -R eye] with K upper triangular: rows of R by Gram-Schmidt from the bottom row up.
FittedCamera take_apart(const Eigen::Matrix<double, 3, 4>& projection, int height, glm::dvec2 middle) {
  const Eigen::Matrix3d left = projection.leftCols<3>() / projection.row(2).head<3>().norm();
  const Eigen::Vector3d eye = -projection.leftCols<3>().partialPivLu().solve(projection.col(3));
  const Eigen::Vector3d forward = left.row(2);
  const double centre_y = left.row(1).dot(forward), centre_x = left.row(0).dot(forward);
  const Eigen::Vector3d down_scaled = left.row(1).transpose() - centre_y * forward;
  const double focal = down_scaled.norm();
  const Eigen::Vector3d down = down_scaled / focal;
  Eigen::Vector3d right = left.row(0).transpose() - centre_x * forward;
  right = (right - right.dot(down) * down).normalized();

  FittedCamera camera;
  const Eigen::Vector3d rows[] = {right, -down, -forward};  // our camera: y up, looks along -z
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) camera.world_to_camera[column][row] = rows[row][column];
    camera.world_to_camera[3][row] = -rows[row].dot(eye);
  }
  camera.vertical_fov = 2 * std::atan(0.5 * height / focal);
  camera.off_centre_pixels = glm::length(glm::dvec2(centre_x, centre_y) - middle);
  return camera;
}

}  // namespace

std::optional<FittedCamera> fit_camera(int width, int height, const std::array<Plane, 3>& position,
                                       const std::vector<std::uint8_t>& valid) {
  const std::vector<Sample> samples = take_samples(width, height, position, valid);
  if (samples.size() < 6) return std::nullopt;
  const glm::dvec2 middle(0.5 * width, 0.5 * height);
  const auto projection = solve_projection(samples, middle);
  if (!projection) return std::nullopt;
  // Seen from infinitely far, depth does not vary: the bottom row has no direction.
  double nearest = 1e300, farthest = -1e300;
  for (const Sample& sample : samples) {
    const double depth = projection->row(2).dot(Eigen::Vector4d(sample.point.x, sample.point.y, sample.point.z, 1));
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  if (!(nearest > 0) || farthest - nearest < 1e-4) return std::nullopt;

  FittedCamera camera = take_apart(*projection, height, middle);
  for (const Sample& sample : samples) {
    const Eigen::Vector3d seen = *projection * Eigen::Vector4d(sample.point.x, sample.point.y, sample.point.z, 1);
    const glm::dvec2 pixel(seen[0] / seen[2], seen[1] / seen[2]);
    camera.error_pixels = std::max(camera.error_pixels, glm::length(pixel - sample.pixel));
  }
  return camera;
}

std::optional<ParallelCamera> fit_parallel_camera(int width, int height, const std::array<Plane, 3>& position,
                                                  const std::vector<std::uint8_t>& valid) {
  const std::vector<Sample> samples = take_samples(width, height, position, valid);
  if (samples.size() < 4) return std::nullopt;
  glm::dvec3 centroid(0);
  for (const Sample& sample : samples) centroid += sample.point / static_cast<double>(samples.size());
  // Pixels are a linear map of points; the smallest one where points of a plane leave a choice.
  Eigen::MatrixXd equations(static_cast<Eigen::Index>(samples.size()), 4);
  Eigen::MatrixXd pixels(equations.rows(), 2);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const glm::dvec3 p = samples[i].point - centroid;
    equations.row(static_cast<Eigen::Index>(i)) << p.x, p.y, p.z, 1;
    pixels.row(static_cast<Eigen::Index>(i)) << samples[i].pixel.x, samples[i].pixel.y;
  }
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition(equations);
  decomposition.setThreshold(1e-6);
  const Eigen::MatrixXd solution = decomposition.solve(pixels);
  const glm::dvec3 across(solution(0, 0), solution(1, 0), solution(2, 0));
  const glm::dvec3 downwards(solution(0, 1), solution(1, 1), solution(2, 1));
  const double scale = glm::length(across), other = glm::length(downwards);  // pixels per metre
  if (!(scale > 0) || std::abs(other / scale - 1) > 1e-3 ||
      std::abs(glm::dot(across, downwards)) > 1e-3 * scale * other)
    return std::nullopt;
  ParallelCamera camera;
  camera.error_pixels = (equations * solution - pixels).rowwise().norm().maxCoeff();
  if (!(camera.error_pixels < 0.5)) return std::nullopt;

  const glm::dvec3 right = across / scale;
  const glm::dvec3 down = glm::normalize(downwards - glm::dot(downwards, right) * right);
  const glm::dvec3 forward = glm::cross(right, down);
  double nearest = 1e300;
  for (const Sample& sample : samples) nearest = std::min(nearest, glm::dot(sample.point, forward));
  // The pixel of the camera's axis is the middle of the image.
  const glm::dvec2 offset =
      (glm::dvec2(0.5 * width, 0.5 * height) - glm::dvec2(solution(3, 0), solution(3, 1))) / scale;
  const glm::dvec3 on_axis = centroid + offset.x * right + offset.y * down;
  const glm::dvec3 rows[3] = {right, -down, -forward};
  const glm::dvec3 eye = on_axis + (nearest - 1 - glm::dot(on_axis, forward)) * forward;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) camera.world_to_camera[column][row] = rows[row][column];
    camera.world_to_camera[3][row] = -glm::dot(rows[row], eye);
  }
  camera.height = height / scale;
  return camera;
}

glm::dvec2 project(const Frame& frame, glm::dvec3 point) {
  const glm::dvec4 seen = frame.world_to_camera * glm::dvec4(point, 1);
  const double focal = 0.5 * frame.height / std::tan(0.5 * frame.vertical_fov);
  return {0.5 * frame.width + focal * seen.x / -seen.z, 0.5 * frame.height - focal * seen.y / -seen.z};
}

}  // namespace understory
