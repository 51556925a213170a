// `obscurance-area` in double, by other means than the kernels: moments from sums of squares, depths and the plane's
// own slope from rays as vectors in space, the integral of the openness piece by piece.
#pragma once
#include <array>
#include <vector>

#include "tests/reference/obscurance.hpp"

namespace understory::reference {

/// Mean and variance of 1/z (orthographic: -z) around texels of 2^level pixels, and the share that is no background.
struct DepthMoment {
  double mean = 0, variance = 0, coverage = 0;
};

class MomentPyramid {
 public:
  explicit MomentPyramid(const DepthImage& image) {
    Level finest{image.view.width, image.view.height, {}};
    for (const double depth : image.depth)
      finest.texels.push_back(std::isinf(depth) ? DepthMoment{}
                                                : DepthMoment{image.view.perspective ? 1 / depth : -depth, 0, 1});
    levels_.push_back(std::move(finest));
    while (levels_.back().width > 1 || levels_.back().height > 1) levels_.push_back(halved(levels_.back()));
  }

  /// Between texels and between levels, at (x, y) pixels from the image's corner, over texels of `side` pixels.
  /// `plane_variance`: of a plane's value, pixels^2 of its slope.
  DepthMoment at(double x, double y, double side, double& plane_variance) const {
    const double size = std::clamp(side, 1.0, 65536.0);
    const int level = static_cast<int>(std::floor(std::log2(size)));
    const double between = size / std::exp2(level) - 1;
    const int last = static_cast<int>(levels_.size()) - 1;
    DepthMoment sum;
    plane_variance = 0;
    for (const auto& [which, share] : {std::pair{level, 1 - between}, std::pair{level + 1, between}}) {
      const int held = std::min(which, last);
      const DepthMoment part = of_level(held, x, y);  // times its coverage
      sum.mean += share * part.mean;
      sum.variance += share * part.variance;
      sum.coverage += share * part.coverage;
      plane_variance += share * (std::exp2(2 * held) - 1) / 4;
    }
    const double covered = std::max(sum.coverage, 1e-6);
    return {sum.mean / covered, sum.variance / covered, sum.coverage};
  }

 private:
  struct Level {
    int width, height;
    std::vector<DepthMoment> texels;
    const DepthMoment& at(int x, int y) const { return texels[static_cast<std::size_t>(y * width + x)]; }
  };

  static Level halved(const Level& from) {
    Level to{(from.width + 1) / 2, (from.height + 1) / 2, {}};
    constexpr std::array taps = {1.0, 3.0, 3.0, 1.0};
    for (int y = 0; y < to.height; ++y)
      for (int x = 0; x < to.width; ++x) {
        double all = 0, counting = 0, sum = 0, squares = 0;
        for (int tap = 0; tap < 16; ++tap) {
          const int column = 2 * x - 1 + tap % 4, row = 2 * y - 1 + tap / 4;
          if (column < 0 || row < 0 || column >= from.width || row >= from.height) continue;
          const DepthMoment& one = from.at(column, row);
          const double weight = taps[static_cast<std::size_t>(tap % 4)] * taps[static_cast<std::size_t>(tap / 4)];
          all += weight;
          counting += weight * one.coverage;
          sum += weight * one.coverage * one.mean;
          squares += weight * one.coverage * (one.variance + one.mean * one.mean);
        }
        DepthMoment moment;
        if (counting > 0) {
          moment.mean = sum / counting;
          moment.variance = std::max(squares / counting - moment.mean * moment.mean, 0.0);
        }
        moment.coverage = counting / all;
        to.texels.push_back(moment);
      }
    return to;
  }

  DepthMoment of_level(int number, double x, double y) const {
    const Level& level = levels_[static_cast<std::size_t>(number)];
    const double u = x / std::exp2(number) - 0.5, v = y / std::exp2(number) - 0.5;
    const double left = std::floor(u), top = std::floor(v);
    DepthMoment sum;
    for (int corner = 0; corner < 4; ++corner) {
      const int right = corner & 1, below = corner >> 1;
      const DepthMoment& one = level.at(std::clamp(static_cast<int>(left) + right, 0, level.width - 1),
                                        std::clamp(static_cast<int>(top) + below, 0, level.height - 1));
      const double weight = (right ? u - left : 1 - u + left) * (below ? v - top : 1 - v + top) * one.coverage;
      sum.mean += weight * one.mean;
      sum.variance += weight * one.variance;
      sum.coverage += weight;
    }
    return sum;
  }

  std::vector<Level> levels_;
};

/// Integral over a line of length 2 half, up to `end`, of an openness that falls evenly from 1 at mean - spread to 0 at
/// mean + spread: of a function of straight pieces, by trapezoids between its corners.
inline double open_line_before_box(double half, double end, double mean, double spread) {
  const double s = std::max(spread, 1e-5), last = std::clamp(end, -half, half);
  const auto openness = [&](double z) { return std::clamp((mean + s - z) / (2 * s), 0.0, 1.0); };
  const std::array corners = {-half, std::clamp(mean - s, -half, last), std::clamp(mean + s, -half, last), last};
  double sum = 0;
  for (std::size_t i = 1; i < corners.size(); ++i)
    sum += (corners[i] - corners[i - 1]) * 0.5 * (openness(corners[i]) + openness(corners[i - 1]));
  return sum;
}

/// `pyramid`: of the image; `box`: half-width of the box of depths in standard deviations. `nearest_edge`: pixels from
/// a sample to the image's border, where it is in or out.
inline Obscurance area_obscurance(const DepthImage& image, const MomentPyramid& pyramid, int x, int y,
                                  const ObscuranceSampleSet& set, const NearField& options, double radius, double box) {
  const ObscuranceView& view = image.view;
  const PixelRay own_ray = pixel_ray(view, x, y);
  const Ball ball(image, x, y, radius);
  const bool normals = options.normals != "none";
  const auto place = [&](double column, double row) {  // ray through a place of the image, pixels from its corner
    const glm::dvec3 across((column - view.centre_x) / view.focal, (row - view.centre_y) / view.focal, 0);
    return view.perspective ? PixelRay{glm::dvec3(0), across + glm::dvec3(0, 0, 1)} : PixelRay{across, {0, 0, 1}};
  };
  // What the tangent plane's 1/z (-z) changes by from pixel to pixel.
  const auto plane_value = [&](double column, double row) {
    const PixelRay ray = place(column, row);
    const double over = glm::dot(ball.normal, ray.direction), z = glm::dot(ball.centre - ray.origin, ball.normal);
    return view.perspective ? over / z : -z / over;
  };
  const double here = plane_value(x + 0.5, y + 0.5);
  const double slope_square =
      std::pow(plane_value(x + 1.5, y + 0.5) - here, 2) + std::pow(plane_value(x + 0.5, y + 1.5) - here, 2);
  const double angle = 2 * std::numbers::pi * pattern_turn(x, y), c = std::cos(angle), s = std::sin(angle);
  const double side = ball.pixels * std::sqrt(std::numbers::pi / (3.0 * static_cast<double>(set.samples.size())));
  Obscurance result;
  double open = 0, flat = 0;
  for (const ObscuranceSample& sample : set.samples) {
    const glm::dvec2 p(double{sample.x}, double{sample.y});
    const double half = std::sqrt(1 - glm::dot(p, p)), share = double{sample.constant_share} / (2 * half);
    glm::dvec3 step = (c * p.x + s * p.y) * ball.right + (s * p.x - c * p.y) * ball.down;
    step -= step.z * own_ray.direction;
    const glm::dvec2 goal = glm::dvec2(x + 0.5, y + 0.5) + glm::dvec2(step) * ball.pixels;
    const glm::dvec2 inner = glm::min(goal, glm::dvec2(view.width, view.height) - goal);
    result.nearest_edge = std::min({result.nearest_edge, std::abs(inner.x), std::abs(inner.y)});
    if (inner.x < 0 || inner.y < 0) continue;
    double plane_variance;
    const DepthMoment moment = pyramid.at(goal.x, goal.y, side, plane_variance);
    const double depth = view.perspective ? 1 / std::max(moment.mean, 1e-18) : -moment.mean;
    const PixelRay ray = place(goal.x, goal.y);
    const auto along = [&](double z) { return std::min(glm::dot(ray.at(z) - ball.centre, ball.sight) / radius, 1e6); };
    const double facing = glm::dot(ball.normal, ray.direction);
    if (facing > -2e-3 || ball.facing() > -2e-3) result.doubt = 1;
    const double plane = !normals         ? 1e6
                         : facing > -1e-3 ? 1e6
                                          : along(glm::dot(ball.centre - ray.origin, ball.normal) / facing);
    const double own = normals ? plane_variance * slope_square * 1.002 : 0;
    const double deviation = box * std::sqrt(std::max(moment.variance - own, 0.0));
    const double spread =
        std::min(deviation * (view.perspective ? depth * depth : 1) * glm::length(own_ray.direction) / radius, 1e6);
    const double seen = along(depth), whole = std::clamp(plane, -half, half) + half;
    double length = open_line_before_box(half, plane, seen, spread);
    if (options.thickness > 0)
      length += whole - open_line_before_box(half, plane, seen + options.thickness / radius, spread);
    const double covered = std::min(moment.coverage, 1.0);
    open += share * (covered * length + (1 - covered) * whole);
    flat += share * (normals ? whole : half);
  }
  result.value = flat > 1e-6 ? std::clamp(open / flat, 0.0, 1.0) : 1;
  return result;
}

}  // namespace understory::reference
