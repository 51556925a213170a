#include "host/trace/own_shadow_bake.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "host/trace/bake_cache.hpp"
#include "host/trace/directions.hpp"
#include "host/trace/tracer.hpp"
#include "host/trace/truth.hpp"
#include "sim/error.hpp"
#include "sim/random.hpp"

namespace understory {
namespace {

/// Raised whenever the same input gives another shadow, or the layout of its bytes changes.
constexpr std::uint32_t version = 1;

constexpr std::size_t surface_points = 16384;  // some ten for each sample that meets the surface
constexpr std::size_t points_together = 64;

/// Fewer rays than this share are chance meetings at the seams of a convex body's triangles.
constexpr double least_share = 1e-4;

struct Surface {
  std::span<const glm::vec3> vertices;
  std::span<const std::uint32_t> triangles;
  std::vector<double> area_before;  // of each triangle, and of all at the end
  glm::vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};

  glm::vec3 corner(std::size_t triangle, std::size_t k) const { return vertices[triangles[3 * triangle + k]]; }
};

Surface surface_of(std::span<const glm::vec3> vertices, std::span<const std::uint32_t> triangles) {
  Surface surface{vertices, triangles, {0}};
  for (std::size_t t = 0; t < triangles.size() / 3; ++t) {
    const glm::vec3 a = surface.corner(t, 0), b = surface.corner(t, 1), c = surface.corner(t, 2);
    surface.area_before.push_back(surface.area_before.back() + 0.5 * double(glm::length(glm::cross(b - a, c - a))));
    surface.low = glm::min(surface.low, glm::min(a, glm::min(b, c)));
    surface.high = glm::max(surface.high, glm::max(a, glm::max(b, c)));
  }
  return surface;
}

/// Point `number` of surface_points, even by area, with the triangle's normal.
OwnShadowPoint point_on(const Surface& surface, std::size_t number, std::uint64_t seed) {
  const std::vector<double>& before = surface.area_before;
  const double place = (static_cast<double>(number) + 0.5) / static_cast<double>(surface_points) * before.back();
  const auto after = std::upper_bound(before.begin(), before.end() - 1, place);
  const auto triangle = static_cast<std::size_t>(after - before.begin()) - 1;
  const glm::vec2 u = scrambled_sobol(static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(mix_bits(seed)));
  const glm::vec3 a = surface.corner(triangle, 0), b = surface.corner(triangle, 1), c = surface.corner(triangle, 2);
  const float root = std::sqrt(u.x);
  OwnShadowPoint point;
  point.position = a + root * ((1 - u.y) * (b - a) + u.y * (c - a));
  point.normal = glm::normalize(glm::cross(b - a, c - a));
  return point;
}

/// Shares of rays that meet the body again, for the points `first` to `last` - 1, on both sides of each.
void trace_points(const Tracer& tracer, const Surface& surface, std::uint32_t rays, std::uint64_t seed,
                  std::size_t first, std::size_t last, std::vector<OwnShadowPoint>& points) {
  const glm::vec3 middle = 0.5f * (surface.low + surface.high);
  std::vector<Ray> lines(rays);
  std::vector<std::uint8_t> blocked(rays);
  for (std::size_t number = first; number < last; ++number)
    for (const float side : {1.0f, -1.0f}) {
      OwnShadowPoint& point = points[2 * number + (side < 0)];
      point = point_on(surface, number, seed);
      point.normal *= side;
      const glm::mat3 frame = frame_about(point.normal);
      const glm::vec3 start = point.position + surface_offset(point.position - middle, glm::vec3(0)) * point.normal;
      const auto scramble = static_cast<std::uint32_t>(mix_bits(seed + 1 + 2 * number + (side < 0)));
      for (std::uint32_t i = 0; i < rays; ++i)
        lines[i].origin = start, lines[i].direction = frame * cosine_hemisphere(scrambled_sobol(i, scramble));
      tracer.blocked(lines, blocked);
      point.share = static_cast<float>(std::count(blocked.begin(), blocked.end(), 1)) / static_cast<float>(rays);
    }
}

/// A flat body's box has no thickness: it gets some.
void thicken(glm::vec3& low, glm::vec3& high) {
  const glm::vec3 middle = 0.5f * (low + high), half = 0.5f * (high - low);
  const glm::vec3 enough = glm::max(half, glm::vec3(std::max({half.x, half.y, half.z}) / 16));
  low = middle - enough;
  high = middle + enough;
}

}  // namespace

OwnShadow bake_own_shadow(std::span<const glm::vec3> vertices, std::span<const std::uint32_t> triangles,
                          std::uint32_t rays, std::uint64_t seed) {
  const Tracer tracer(vertices, triangles);
  Surface surface = surface_of(vertices, triangles);
  if (!(surface.area_before.back() > 0 && std::isfinite(surface.area_before.back())))
    throw Error(ErrorKind::invalid_input, "the mesh has no area, or vertices that are not finite");
  std::vector<OwnShadowPoint> points(2 * surface_points);
  tbb::parallel_for(std::size_t(0), surface_points / points_together, [&](std::size_t part) {
    trace_points(tracer, surface, rays, seed, part * points_together, (part + 1) * points_together, points);
  });
  std::erase_if(points, [](const OwnShadowPoint& point) { return !(point.share < 1); });
  double sum = 0;
  for (const OwnShadowPoint& point : points) sum += double(point.share);
  if (sum < least_share * static_cast<double>(points.size())) return {};
  thicken(surface.low, surface.high);
  return fit_own_shadow(points, surface.low, surface.high);
}

OwnShadow cached_own_shadow(std::span<const glm::vec3> vertices, std::span<const std::uint32_t> triangles,
                            std::uint32_t rays, std::uint64_t seed) {
  ContentHash hash;
  hash.add(version);
  hash.add(vertices);
  hash.add(triangles);
  hash.add(rays);
  hash.add(seed);
  constexpr std::size_t head = sizeof(OwnShadow::size) + 2 * sizeof(glm::vec3);
  if (const std::optional<std::string> bytes = load_bake("own-shadow", hash); bytes && bytes->size() >= head) {
    OwnShadow shadow;
    std::memcpy(&shadow.size, bytes->data(), sizeof shadow.size);
    std::memcpy(&shadow.low, bytes->data() + sizeof shadow.size, sizeof shadow.low);
    std::memcpy(&shadow.high, bytes->data() + sizeof shadow.size + sizeof shadow.low, sizeof shadow.high);
    const std::size_t samples = (bytes->size() - head) / sizeof(glm::vec4), size = shadow.size;
    if (samples * sizeof(glm::vec4) == bytes->size() - head && samples == size * size * size) {
      shadow.fit.resize(samples);
      std::memcpy(shadow.fit.data(), bytes->data() + head, bytes->size() - head);
      return shadow;
    }
  }
  const OwnShadow shadow = bake_own_shadow(vertices, triangles, rays, seed);
  std::string bytes;
  bytes.append(reinterpret_cast<const char*>(&shadow.size), sizeof shadow.size);
  bytes.append(reinterpret_cast<const char*>(&shadow.low), sizeof shadow.low);
  bytes.append(reinterpret_cast<const char*>(&shadow.high), sizeof shadow.high);
  bytes.append(reinterpret_cast<const char*>(shadow.fit.data()), shadow.fit.size() * sizeof(glm::vec4));
  store_bake("own-shadow", hash, bytes);
  return shadow;
}

}  // namespace understory
