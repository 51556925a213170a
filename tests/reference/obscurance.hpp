// Obscurance in double, by other means than the kernels: points, rays and planes as vectors in space, the angle of the
// rotation from a table and the library, lengths by clipping intervals, the falloff by Simpson's rule.
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "host/passes/obscurance.hpp"

namespace understory::reference {

/// A depth plane and normals (camera axes: right, down, forward) as some camera saw them.
struct DepthImage {
  ObscuranceView view;
  std::vector<double> depth;  // camera z, m; infinity: background
  std::vector<glm::dvec3> normal;
  double depth_at(int x, int y) const { return depth[static_cast<std::size_t>(y * view.width + x)]; }
  glm::dvec3 normal_at(int x, int y) const { return normal[static_cast<std::size_t>(y * view.width + x)]; }
};

/// Origin and direction (forward component 1) of the ray through a pixel's centre, camera axes.
struct PixelRay {
  glm::dvec3 origin{0}, direction{0, 0, 1};
  glm::dvec3 at(double depth) const { return origin + depth * direction; }
};

inline PixelRay pixel_ray(const ObscuranceView& view, int x, int y) {
  const glm::dvec3 across((x + 0.5 - view.centre_x) / view.focal, (y + 0.5 - view.centre_y) / view.focal, 0);
  if (view.perspective) return {glm::dvec3(0), across + glm::dvec3(0, 0, 1)};
  return {across, glm::dvec3(0, 0, 1)};
}

inline double pattern_turn(int x, int y) {
  constexpr int bayer[4][4] = {{0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};
  return bayer[y & 3][x & 3] / 16.0 - 0.5;
}

struct Obscurance {
  double value = 1;
  double nearest_edge = 1;  // of a sample to the border between two pixels, pixels: what float may round otherwise
  double doubt = 0;  // share of points about as deep as what is seen, of lines where that is about to leave the ball
};

/// The ball around a pixel's fragment: its frame, and the neighbour that a point of the disc falls on.
class Ball {
 public:
  Ball(const DepthImage& image, int x, int y, double radius) : image_(image), x_(x), y_(y), radius_(radius) {
    const PixelRay ray = pixel_ray(image.view, x, y);
    centre = ray.at(image.depth_at(x, y));
    sight = glm::normalize(ray.direction);
    // The rotation that takes the camera's axis to the sight, by the shorter way, takes x and y along.
    const glm::dvec3 half = glm::normalize(sight + glm::dvec3(0, 0, 1));
    const auto turned = [&](glm::dvec3 v) { return 2 * glm::dot(v, half) * half - v; };
    right = -turned(glm::dvec3(1, 0, 0));
    down = -turned(glm::dvec3(0, 1, 0));
    normal = image.normal_at(x, y);
    pixels = image.view.focal * radius / (image.view.perspective ? centre.z : 1);
  }

  /// What the pixel shows in which a point of the ball is seen.
  struct Seen {
    bool inside = false;
    double depth = 0;   // along the sight, radii
    double height = 0;  // above the tangent plane, radii
    double facing = 0;  // cosine between normal and ray, times the ray's length
  };
  Seen look(const glm::dvec3& p, double& nearest_edge) const {
    const glm::dvec3 point = centre + radius_ * (p.x * right + p.y * down + p.z * sight);
    const ObscuranceView& view = image_.view;
    const double scale = view.focal / (view.perspective ? point.z : 1);
    const glm::dvec2 place(point.x * scale + view.centre_x, point.y * scale + view.centre_y), cell = glm::floor(place);
    for (const double distance : {place.x - cell.x, place.y - cell.y})
      nearest_edge = std::min(nearest_edge, std::min(distance, 1 - distance));
    Seen seen;
    seen.inside = !(view.perspective && point.z <= 0) && cell.x >= 0 && cell.y >= 0 && cell.x < view.width &&
                  cell.y < view.height;
    if (!seen.inside) return seen;
    const int column = static_cast<int>(cell.x), row = static_cast<int>(cell.y);
    const PixelRay ray = pixel_ray(view, column, row);
    const double depth = image_.depth_at(column, row);
    seen.depth = std::isinf(depth) ? 1e6 : glm::dot(ray.at(depth) - centre, sight) / radius_;
    seen.facing = glm::dot(normal, ray.direction);
    seen.height = std::isinf(depth) ? -1e6 : glm::dot(ray.at(depth) - centre, normal) / radius_;
    return seen;
  }

  /// Of four pixels about the disc's point (x, y), every second one of a large ball's: how deep the line through that
  /// point first meets a surface along the sight, radii, were it parallel to the tangent plane through what the pixel
  /// shows.
  struct Row {
    bool inside = false;
    double seen[4] = {};
    double plane = 0;  // of the line itself
    bool doubtful = false;
  };
  Row look_along_row(double x, double y, bool normals, double& nearest_edge) const {
    const glm::dvec2 offset = image_offset(x, y), goal = glm::dvec2(x_ + 0.5, y_ + 0.5) + offset;
    const int width = image_.view.width, height = image_.view.height;
    const bool single = pixels < 4 || width < 4, wide = pixels >= 24 && width >= 7;
    const int spacing = wide ? 2 : 1;
    const double start = single ? goal.x : goal.x - 1.5 * spacing;
    for (const double distance :
         {std::abs(start - std::round(start)), std::abs(goal.y - std::round(goal.y)), std::abs(goal.x),
          std::abs(goal.x - width), std::abs(pixels - 4), std::abs(pixels - 24)})
      nearest_edge = std::min(nearest_edge, distance);
    Row row;
    row.inside = goal.x >= 0 && goal.y >= 0 && goal.x < width && goal.y < height;
    if (!row.inside) return row;
    const int first = std::clamp(static_cast<int>(std::floor(start)), 0, single ? width - 1 : width - 1 - 3 * spacing);
    const glm::dvec3 to_line = x * right + y * down;
    const double steepness = std::min(facing(), -1e-3) / glm::length(pixel_ray(image_.view, x_, y_).direction);
    row.plane = -glm::dot(normal, to_line) / steepness;
    const double beyond = (1 - glm::dot(sight, glm::dvec3(offset / pixels, 0))) * radius_ * sight.z;
    for (int k = 0; k < 4; ++k) {
      const int column = single ? first : first + k * spacing, line = static_cast<int>(std::floor(goal.y));
      const double depth = image_.depth_at(column, line), step = depth - centre.z;
      const glm::dvec3 there = (pixel_ray(image_.view, column, line).at(depth) - centre) / radius_;
      row.doubtful = row.doubtful || std::abs(step - beyond) < 1e-4 * radius_;
      row.seen[k] = step > beyond ? 1e6
                    : normals     ? row.plane + glm::dot(normal, there) / steepness
                                  : glm::dot(sight, there);
    }
    return row;
  }

  /// Cosine between the normal and the fragment's own ray, times that ray's length; negative.
  double facing() const { return glm::dot(normal, pixel_ray(image_.view, x_, y_).direction); }

  glm::dvec3 centre{0}, sight{0}, right{0}, down{0}, normal{0};
  double pixels = 0;

 private:
  /// Pixels from the fragment: a point of the disc moved along the fragment's ray to the fragment's own depth, then
  /// seen.
  glm::dvec2 image_offset(double x, double y) const {
    glm::dvec3 step = x * right + y * down;
    step -= step.z * pixel_ray(image_.view, x_, y_).direction;
    return glm::dvec2(step) * pixels;
  }

  const DepthImage& image_;
  int x_, y_;
  double radius_;
};

/// Share of backs that are in front of z; 0: no end.
inline double open_behind(double z, double seen, double thickness) {
  return thickness > 0 ? std::clamp((z - seen) / (2 * thickness), 0.0, 1.0) : 0.0;
}

/// Integral of the falloff over the open part of a line of length 2 half: open in front of `seen`, behind it as
/// open_behind has it, nowhere behind `plane`. Simpson's rule is exact for both falloffs, straight ramps included.
inline double open_line(double half, double seen, double thickness, double plane, bool quadratic) {
  const auto falloff = [&](double z) { return quadratic ? half * half - z * z : 1.0; };
  const auto part = [&](double from, double to, const std::function<double(double)>& share) {
    from = std::clamp(from, -half, half);
    to = std::clamp(to, -half, half);
    if (to <= from) return 0.0;
    const auto at = [&](double z) { return share(z) * falloff(z); };
    return (to - from) / 6 * (at(from) + 4 * at((from + to) / 2) + at(to));
  };
  const auto whole = [](double) { return 1.0; };
  const double front = part(-half, std::min(seen, plane), whole);
  if (thickness <= 0) return front;
  const double back = seen + 2 * thickness;
  return front + part(back, plane, whole) +
         part(seen, std::min(back, plane), [&](double z) { return open_behind(z, seen, thickness); });
}

/// Of the ball that samples fill, along right, down and sight, radii; and its size.
struct FilledBall {
  glm::dvec3 middle{0};
  double size = 1;
};
inline FilledBall filled_ball(const Ball& ball, const NearField& options) {
  if (options.falloff != "cosine" || options.normals == "none") return {};
  return {0.5 * glm::dvec3(glm::dot(ball.normal, ball.right), glm::dot(ball.normal, ball.down),
                           glm::dot(ball.normal, ball.sight)),
          0.5};
}

inline Obscurance line_obscurance(const DepthImage& image, int x, int y, const ObscuranceSampleSet& set,
                                  const NearField& options, double radius) {
  const Ball ball(image, x, y, radius);
  const bool quadratic = options.falloff == "quadratic", normals = options.normals != "none";
  const double angle = 2 * std::numbers::pi * pattern_turn(x, y), c = std::cos(angle), s = std::sin(angle);
  Obscurance result;
  double open = 0, flat = 0;
  const FilledBall filled = filled_ball(ball, options);
  for (const ObscuranceSample& sample : set.samples) {
    const glm::dvec2 p = filled.size * glm::dvec2(double{sample.x}, double{sample.y});
    const double half = std::sqrt(filled.size * filled.size - glm::dot(p, p));
    const double whole = open_line(half, 9, 0, 9, quadratic);
    const double share = double{quadratic ? sample.quadratic_share : sample.constant_share} / whole;
    double edge = 1;
    const Ball::Row row =
        ball.look_along_row(c * p.x + s * p.y + filled.middle.x, s * p.x - c * p.y + filled.middle.y, normals, edge);
    if (p != glm::dvec2(0) || filled.size < 1) result.nearest_edge = std::min(result.nearest_edge, edge);
    if (!row.inside) continue;
    const double plane = normals ? row.plane - filled.middle.z : 1e6;
    for (const double seen : row.seen)
      open += share / 4 * open_line(half, seen - filled.middle.z, options.thickness / radius, plane, quadratic);
    flat += share * open_line(half, normals ? plane : 0, 0, 1e6, quadratic);
    if (row.doubtful) result.doubt += share;
  }
  result.value = flat > 1e-6 ? std::clamp(open / flat, 0.0, 1.0) : 1;
  return result;
}

inline Obscurance point_obscurance(const DepthImage& image, int x, int y, const ObscuranceSampleSet& set,
                                   const NearField& options, double radius) {
  const Ball ball(image, x, y, radius);
  const bool quadratic = options.falloff == "quadratic", normals = options.normals != "none";
  const double k = 16 * (pattern_turn(x, y) + 0.5);
  const double height = (k + 0.5) / 16, turn = 2 * std::numbers::pi * (k * 0.61803399 - 0.5);
  const double flat = std::sqrt(1 - height * height);
  const glm::dvec3 mirror(flat * std::cos(turn), flat * std::sin(turn), height);
  const glm::dvec3 normal(glm::dot(ball.normal, ball.right), glm::dot(ball.normal, ball.down),
                          glm::dot(ball.normal, ball.sight));
  Obscurance result;
  double open = 0, all = 0;
  const FilledBall filled = filled_ball(ball, options);
  for (const ObscuranceSample& sample : set.samples) {
    glm::dvec3 p = filled.middle +
                   filled.size * glm::reflect(glm::dvec3(double{sample.x}, double{sample.y}, double{sample.z}), mirror);
    if (normals && filled.size == 1 && glm::dot(p, normal) < 0) p = glm::reflect(p, normal);
    const Ball::Seen seen = ball.look(p, result.nearest_edge);
    if (!seen.inside) continue;
    const double share = double{quadratic ? sample.quadratic_share : sample.constant_share};
    const double hidden = p.z - seen.depth;
    const bool by_height = normals && seen.facing < -1e-3;
    const double margin = by_height ? seen.height + 1e-4 * ball.facing() - std::abs(glm::dot(p, normal)) : hidden;
    open += share * (margin < 0 ? 1 : open_behind(p.z, seen.depth, options.thickness / radius));
    if (std::abs(margin) < 1e-3 || (normals && std::abs(seen.facing + 1e-3) < 1e-4)) result.doubt += share;
    all += (normals ? 1 : 0.5) * share;
  }
  result.value = all > 1e-6 ? std::clamp(open / all, 0.0, 1.0) : 1;
  return result;
}

}  // namespace understory::reference
