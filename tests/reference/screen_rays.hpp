// `screen-rays` in double, by other means than the kernel: places along rays found by bisection in space, what pixels
// show carried along planes by cutting rays with them, axes about the normal by reflection, angles from the library.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

#include "tests/reference/obscurance.hpp"

namespace understory::reference {

struct ScreenRays {
  double value = 1;
  bool left = false;  // a ray left the image
  int doubtful = 0;   // rays that float may judge otherwise: close to a pixel's border, or about as deep as something
};

/// One fragment's rays. Lengths in metres, camera axes, places in pixels.
class ScreenRayMarch {
 public:
  ScreenRayMarch(const DepthImage& image, int x, int y, const NearField& near)
      : image_(image),
        view_(image.view),
        near_(near),
        turn_(static_cast<int>(std::lround((pattern_turn(x, y) + 0.5) * 16))) {
    centre_ = pixel_ray(view_, x, y).at(image.depth_at(x, y));
    normal_ = image.normal_at(x, y);
    start_ = glm::dvec2(x + 0.5, y + 0.5);
  }

  ScreenRays all(int rays) {
    ScreenRays result;
    double open = 0, behind = 0, clutter = 0, clear = 0;
    for (int i = 0; i < rays; ++i) {
      const Ray ray = ray_of(i, rays);
      Stretches stretches;
      doubt_ = false;
      bool blocked = march(ray, stretches);
      const bool leaves = ray.inside < ray.pixels;
      if (std::abs(ray.inside - ray.pixels) < 1e-3 && leaves) doubt_ = true;
      if (leaves && !blocked) blocked = ends_behind_border(ray);
      result.left |= leaves;
      result.doubtful += doubt_;
      clutter += stretches.clutter;
      clear += stretches.clear;
      open += !blocked;
      if (!blocked) behind += stretches.behind;
    }
    const double near_things = clutter + clear > 0 ? clutter / (clutter + clear) : 0;
    result.value = open / rays * std::exp(-3.0 * near_things * behind / std::max(open, 1.0));  // 3 per metre
    return result;
  }

 private:
  struct Ray {
    glm::dvec3 end;
    glm::dvec2 direction;  // in the image, the longer component 1
    double length, pixels, inside, jitter;
  };
  struct Stretches {
    double behind = 0, clutter = 0, clear = 0;
  };

  glm::dvec2 place_of(glm::dvec3 point) const {
    const double scale = view_.focal / (view_.perspective ? point.z : 1);
    return glm::dvec2(point) * scale + glm::dvec2(view_.centre_x, view_.centre_y);
  }
  PixelRay ray_through(glm::dvec2 place) const {
    const glm::dvec3 across((place - glm::dvec2(view_.centre_x, view_.centre_y)) / view_.focal, 0);
    if (view_.perspective) return {glm::dvec3(0), across + glm::dvec3(0, 0, 1)};
    return {across, glm::dvec3(0, 0, 1)};
  }
  double rounding() const { return 4e-6 * std::abs(centre_.z) + 5e-4 * near_.radius; }
  double width_at(double depth) const { return (view_.perspective ? depth : 1) / view_.focal; }

  /// Share of 2^32 that whole numbers went round, in [-1/2, 1/2).
  static double wrapped(std::uint64_t whole) { return static_cast<std::int32_t>(whole & 0xFFFFFFFFu) / 4294967296.0; }

  Ray ray_of(int i, int rays) const {
    const double square = (i + (turn_ + 0.5) / 16) / rays;
    const double angle =
        2 * std::numbers::pi *
        wrapped(static_cast<std::uint64_t>(i) * 0x9E3779B9u + (static_cast<std::uint64_t>(turn_) << 28));
    const double sign = normal_.z < 0 ? -1 : 1;
    // The rotation that takes the axis of view, or its opposite, to the normal by the shorter way.
    const glm::dvec3 half = glm::normalize(normal_ + glm::dvec3(0, 0, sign));
    const auto turned = [&](glm::dvec3 v) { return v - 2 * glm::dot(v, half) * half; };
    const glm::dvec3 way =
        std::sqrt(square) * (std::cos(angle) * turned({1, 0, 0}) + std::sin(angle) * sign * turned({0, 1, 0})) +
        std::sqrt(1 - square) * normal_;
    Ray ray;
    ray.length = near_.radius;
    if (view_.perspective && centre_.z + ray.length * way.z < 0.1 * centre_.z) ray.length = -0.9 * centre_.z / way.z;
    ray.end = centre_ + ray.length * way;
    const glm::dvec2 across = place_of(ray.end) - start_;
    ray.pixels = std::max(std::abs(across.x), std::abs(across.y));
    ray.direction = across / std::max(ray.pixels, 1e-6);
    ray.inside = ray.pixels;
    const double size[2] = {double(view_.width), double(view_.height)};
    for (int axis = 0; axis < 2; ++axis) {
      if (ray.direction[axis] > 0)
        ray.inside = std::min(ray.inside, (size[axis] - start_[axis] - 1e-3) / ray.direction[axis]);
      if (ray.direction[axis] < 0) ray.inside = std::min(ray.inside, (1e-3 - start_[axis]) / ray.direction[axis]);
    }
    ray.jitter = wrapped(static_cast<std::uint64_t>(turn_ + 16 * i) * 0xC13FA9A9u) + 0.5;
    return ray;
  }

  /// The share of the ray that is seen up to there.
  double share_at(const Ray& ray, double place) const {
    const auto steps = [&](double share) {
      const glm::dvec2 across = place_of(centre_ + share * (ray.end - centre_)) - start_;
      return std::max(std::abs(across.x), std::abs(across.y));
    };
    double low = 0, high = 1;
    for (int i = 0; i < 36; ++i) (steps(0.5 * (low + high)) < place ? low : high) = 0.5 * (low + high);
    return 0.5 * (low + high);
  }

  struct Pixel {
    int x, y;
    double depth;
  };
  Pixel pixel_at(const Ray& ray, double place) {
    const glm::dvec2 at = start_ + place * ray.direction;
    const int x = std::clamp(static_cast<int>(std::floor(at.x)), 0, view_.width - 1);
    const int y = std::clamp(static_cast<int>(std::floor(at.y)), 0, view_.height - 1);
    for (const double v : {at.x, at.y}) doubt_ |= std::abs(v - std::round(v)) < 1e-3;
    return {x, y, image_.depth_at(x, y)};
  }

  /// Depth where the ray of vision through this place cuts the plane through what the pixel shows, parallel to the
  /// fragment's; at most 16 pixel widths from the pixel's own.
  double carried(const Pixel& pixel, glm::dvec2 place) {
    const glm::dvec3 shown = pixel_ray(view_, pixel.x, pixel.y).at(pixel.depth);
    const PixelRay sight = ray_through(place);
    const double facing = glm::dot(normal_, sight.direction), farthest = 16 * width_at(pixel.depth);
    doubt_ |= facing > -2e-3;
    const double cut = glm::dot(normal_, shown - sight.origin) / std::min(facing, -1e-3);
    return std::clamp(cut, pixel.depth - farthest, pixel.depth + farthest);
  }

  void doubt_if_close(double a, double b) { doubt_ |= std::abs(a - b) < 3e-5 * centre_.z; }

  bool march(const Ray& ray, Stretches& stretches) {
    const double on_surface = rounding();
    const double slant = 0.5 * std::abs(ray.end.z - centre_.z);
    double run_width = 0, looked = 0.5;
    std::optional<double> run_depth;
    for (double from = 0.5; from < ray.inside;) {
      const double next = std::min(from + std::max(1.0, 0.2 * from), ray.inside), step = next - from;
      const double place = from + ray.jitter * step, passed = share_at(ray, next) - share_at(ray, from);
      const Pixel pixel = pixel_at(ray, place);
      std::optional<double> seen;
      if (std::isfinite(pixel.depth)) {
        const double depth = carried(pixel, start_ + place * ray.direction), width = width_at(pixel.depth);
        const double behind = centre_.z + share_at(ray, place) * (ray.end.z - centre_.z) - depth;
        doubt_if_close(behind, 0.02 * width + on_surface);
        if (run_depth) doubt_if_close(std::abs(depth - *run_depth), 3 * width);
        const bool joined = run_depth && std::abs(depth - *run_depth) <= 3 * width;
        run_width = joined ? run_width + width * (place - looked) : width;
        if (behind > 0.02 * width + on_surface && width > 0) {
          const double deep = std::max(run_width, near_.thickness) + on_surface + width * std::max(step - 1, 0.0);
          doubt_if_close(behind - slant * passed, deep);
          if (behind - slant * passed < deep) return true;
          doubt_if_close(behind, 1);
          seen = depth;
          stretches.behind += passed * ray.length;
          if (behind < 1) stretches.clutter += passed * ray.length;
        }
      }
      if (!seen) stretches.clear += passed * ray.length;
      run_depth = seen;
      looked = place;
      from = next;
    }
    return false;
  }

  bool ends_behind_border(const Ray& ray) {
    const Pixel last = pixel_at(ray, ray.inside - 0.5);
    if (!std::isfinite(last.depth)) return false;
    const glm::dvec3 border = pixel_ray(view_, last.x, last.y).at(last.depth);
    const double height = glm::dot(ray.end - border, image_.normal_at(last.x, last.y));
    doubt_if_close(height, -rounding());
    return height < -rounding() && width_at(last.depth) > 0;
  }

  const DepthImage& image_;
  const ObscuranceView& view_;
  const NearField& near_;
  int turn_;
  glm::dvec3 centre_, normal_;
  glm::dvec2 start_;
  bool doubt_ = false;
};

inline ScreenRays screen_rays(const DepthImage& image, int x, int y, int rays, const NearField& near) {
  return ScreenRayMarch(image, x, y, near).all(rays);
}

}  // namespace understory::reference
