#include "host/trace/seen_samples.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "host/trace/directions.hpp"

namespace understory {
namespace {

constexpr std::size_t batch = 1024;     // points traced together
constexpr double expected_share = 0.3;  // of points that are seen; on leafy trees 0.2 to 0.4

/// Sums of area before each triangle, and in all at the end.
std::vector<double> area_before(const RestSurface& surface) {
  std::vector<double> sums(surface.triangle_count() + 1, 0.0);
  for (std::size_t i = 0; i < surface.triangle_count(); ++i) sums[i + 1] = sums[i] + double(surface.area(i));
  return sums;
}

/// Point `number` of `count`: evenly by area, on either side.
SurfacePoint point_on(const RestSurface& surface, const std::vector<double>& before, std::size_t number,
                      std::size_t count, std::uint32_t seed) {
  const double place = (static_cast<double>(number) + 0.5) / static_cast<double>(count) * before.back();
  const auto after = std::upper_bound(before.begin(), before.end() - 1, place);
  const auto triangle = static_cast<std::size_t>(after - before.begin()) - 1;
  const auto index = static_cast<std::uint32_t>(number);
  const glm::vec2 u = scrambled_sobol(index, seed), side = scrambled_sobol(index, seed + 1);
  const glm::vec3 a = surface.corner(triangle, 0), b = surface.corner(triangle, 1), c = surface.corner(triangle, 2);
  const float root = std::sqrt(u.x);
  SurfacePoint point;
  point.position = a + root * ((1 - u.y) * (b - a) + u.y * (c - a));
  point.normal = side.x < 0.5f ? surface.normal(triangle) : -surface.normal(triangle);
  return point;
}

glm::vec3 direction_from(const SurfacePoint& point, std::size_t number, std::uint32_t seed) {
  return frame_about(point.normal) * cosine_hemisphere(scrambled_sobol(static_cast<std::uint32_t>(number), seed));
}

/// Points `first` to `last` - 1 that are seen.
std::vector<SeenSample> seen_in(const RestSurface& surface, const std::vector<double>& before, std::size_t first,
                                std::size_t last, std::size_t count, Sky sky, std::uint32_t seed) {
  std::vector<SurfacePoint> points;
  std::vector<glm::vec3> directions;
  for (std::size_t i = first; i < last; ++i) {
    points.push_back(point_on(surface, before, i, count, seed));
    directions.push_back(direction_from(points.back(), i, seed + 2));
  }
  std::vector<std::uint8_t> open(points.size());
  surface.open(points, directions, open);
  std::vector<SeenSample> seen;
  std::vector<SurfacePoint> starts;
  directions.clear();
  for (std::size_t i = first; i < last; ++i) {
    if (!open[i - first]) continue;
    seen.push_back({points[i - first], 0});
    for (std::size_t ray = 0; ray < rays_per_seen_point; ++ray) {
      starts.push_back(seen.back().point);
      directions.push_back(direction_from(starts.back(), i * rays_per_seen_point + ray, seed + 3));
    }
  }
  open.resize(starts.size());
  surface.open(starts, directions, open);
  for (std::size_t ray = 0; ray < starts.size(); ++ray)
    if (open[ray] && (sky == Sky::sphere || directions[ray].z > 0))
      seen[ray / rays_per_seen_point].visibility += 1.0f / rays_per_seen_point;
  return seen;
}

}  // namespace

std::vector<SeenSample> seen_samples(const RestSurface& surface, Sky sky, std::size_t rays, std::uint32_t seed) {
  const std::vector<double> before = area_before(surface);
  if (!(before.back() > 0)) return {};
  const auto count = static_cast<std::size_t>(double(rays) / (1 + expected_share * rays_per_seen_point));
  std::vector<std::vector<SeenSample>> parts((count + batch - 1) / batch);
  tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t part) {
    parts[part] = seen_in(surface, before, part * batch, std::min(count, (part + 1) * batch), count, sky, seed);
  });
  std::vector<SeenSample> all;
  for (const std::vector<SeenSample>& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace understory
