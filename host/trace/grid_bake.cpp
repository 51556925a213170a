#include "host/trace/grid_bake.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/trace/directions.hpp"
#include "host/trace/tracer.hpp"
#include "sim/error.hpp"
#include "sim/random.hpp"

namespace understory {
namespace {

constexpr std::uint32_t least_rays = 16, most_rays = 65536;
constexpr double least_epsilon = 1e-3, largest_epsilon = 1, largest_stretch = 8;

/// Where a body is, for aiming.
struct Ball {
  glm::vec3 centre{0};
  float radius = 0;
};

Box bounds_of(std::span<const glm::vec3> vertices, std::span<const std::uint32_t> triangles) {
  Box box{glm::dvec3(std::numeric_limits<double>::max()), glm::dvec3(std::numeric_limits<double>::lowest())};
  for (const std::uint32_t index : triangles) {
    if (index >= vertices.size())
      throw Error(ErrorKind::invalid_input,
                  fmt::format("triangle index {} is out of range: there are {} vertices", index, vertices.size()));
    const glm::dvec3 p(vertices[index]);
    if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)))
      throw Error(ErrorKind::invalid_input, fmt::format("vertex {} is not finite", index));
    box.low = glm::min(box.low, p);
    box.high = glm::max(box.high, p);
  }
  return box;
}

/// Points of the unit square in an order that keeps neighbours together, so that rays of a stream take like ways.
std::vector<glm::vec2> ordered_points(std::uint32_t count, std::uint64_t seed) {
  std::vector<glm::vec2> points(count);
  for (std::uint32_t i = 0; i < count; ++i) points[i] = scrambled_sobol(i, static_cast<std::uint32_t>(mix_bits(seed)));
  const auto stripes = std::max(1.0f, std::floor(std::sqrt(static_cast<float>(count) / 4)));
  std::sort(points.begin(), points.end(), [&](glm::vec2 a, glm::vec2 b) {
    const float i = std::floor(a.y * stripes), j = std::floor(b.y * stripes);
    return i != j ? i < j : a.x < b.x;
  });
  return points;
}

/// The rays of one sample: all directions within the body's bounding sphere, the whole sphere of them inside it. A
/// sample within the solid gets what the nearest point of the surface sees: receivers beside it lie between such
/// samples.
class SampleTracer {
 public:
  SampleTracer(const Tracer& tracer, const Ball& ball, const std::vector<glm::vec2>& points, std::uint64_t seed)
      : tracer_(tracer),
        ball_(ball),
        points_(points),
        seed_(seed),
        rays_(points.size()),
        blocked_(points.size()),
        hits_(points.size()) {}

  /// Notes in `inside` whether the sample is within the solid.
  OccludedDirections operator()(const glm::vec3& position, std::size_t index, std::uint8_t& inside) {
    const OccludedDirections here = trace_from(position, index);
    inside = here.share >= 1;
    return inside ? trace_from(beside_surface(position), index) : here;
  }

 private:
  OccludedDirections trace_from(const glm::vec3& position, std::size_t index) {
    const glm::vec3 to_centre = ball_.centre - position;
    const float distance = glm::length(to_centre), ratio = ball_.radius / distance;
    const bool outside = ratio < 1;
    const float share = outside ? ratio * ratio / (2 * (1 + std::sqrt(1 - ratio * ratio))) : 1;
    const glm::mat3 frame = outside ? frame_about(to_centre / distance) : glm::mat3(1);
    Random random(seed_, stream_of("grid sample"), index);
    const glm::vec2 shift(random.uniform(), random.uniform());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const glm::vec2 u = glm::fract(points_[i] + shift);
      rays_[i].origin = position;
      rays_[i].direction = frame * uniform_sphere({u.x, share * u.y});
    }
    tracer_.blocked(rays_, blocked_);
    std::size_t hits = 0;
    glm::dvec3 sum(0);
    for (std::size_t i = 0; i < rays_.size(); ++i)
      if (blocked_[i]) ++hits, sum += glm::dvec3(rays_[i].direction);
    const double weight = double(share) / double(rays_.size());
    return {static_cast<float>(weight * double(hits)), glm::vec3(weight * sum)};
  }

  /// Just beyond the nearest surface that the last rays met; all of them met some.
  glm::vec3 beside_surface(const glm::vec3& position) {
    tracer_.nearest(rays_, hits_);
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < hits_.size(); ++i)
      if (hits_[i].distance < hits_[nearest].distance) nearest = i;
    return position + (hits_[nearest].distance + 1e-3f * ball_.radius) * rays_[nearest].direction;
  }

  const Tracer& tracer_;
  const Ball& ball_;
  const std::vector<glm::vec2>& points_;
  std::uint64_t seed_;
  std::vector<Ray> rays_;
  std::vector<std::uint8_t> blocked_;
  std::vector<Hit> hits_;
};

/// Returns for each sample whether it lies within the solid.
std::vector<std::uint8_t> trace(OcclusionGrid& grid, const Tracer& tracer, const Ball& ball,
                                const GridSettings& settings) {
  std::vector<std::uint8_t> inside(grid.samples());
  const std::vector<glm::vec2> points = ordered_points(settings.rays, settings.seed);
  const std::size_t rows = std::size_t(grid.size[1]) * grid.size[2];
  tbb::parallel_for(std::size_t(0), rows, [&](std::size_t row) {
    SampleTracer sample(tracer, ball, points, settings.seed);
    const auto y = static_cast<std::uint32_t>(row % grid.size[1]), z = static_cast<std::uint32_t>(row / grid.size[1]);
    for (std::uint32_t x = 0; x < grid.size[0]; ++x) {
      const std::size_t i = row * grid.size[0] + x;
      const OccludedDirections occluded = sample(grid.position(x, y, z), i, inside[i]);
      grid.share[i] = occluded.share;
      if (grid.has_direction()) grid.direction[i] = occluded.direction;
    }
  });
  return inside;
}

}  // namespace

void check_settings(const GridSettings& settings) {
  for (const std::uint32_t size : settings.size)
    if (size < least_grid_size || size > largest_grid_size)
      throw Error(ErrorKind::invalid_input, fmt::format("grid size {}: allowed are {} to {} samples per axis", size,
                                                        least_grid_size, largest_grid_size));
  if (!(settings.epsilon >= least_epsilon && settings.epsilon <= largest_epsilon))
    throw Error(ErrorKind::invalid_input,
                fmt::format("epsilon {}: allowed are {} to {}", settings.epsilon, least_epsilon, largest_epsilon));
  if (!(settings.stretch >= 0 && settings.stretch <= largest_stretch))
    throw Error(ErrorKind::invalid_input,
                fmt::format("stretch {}: allowed are 0 to {}", settings.stretch, largest_stretch));
  if (settings.rays < least_rays || settings.rays > most_rays)
    throw Error(ErrorKind::invalid_input,
                fmt::format("{} rays per sample: allowed are {} to {}", settings.rays, least_rays, most_rays));
  const double samples = double(settings.size[0]) * settings.size[1] * settings.size[2];
  const double bytes = samples * (settings.cone ? 16 : 4);
  const double free = static_cast<double>(sysconf(_SC_AVPHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  if (bytes > free / 2)
    throw Error(
        ErrorKind::invalid_input,
        fmt::format("a grid of {}x{}x{} samples takes {:.0f} MiB; at most half of the {:.0f} MiB of free memory "
                    "is allowed",
                    settings.size[0], settings.size[1], settings.size[2], bytes / (1 << 20), free / (1 << 20)));
}

OcclusionGrid bake_grid(std::span<const glm::vec3> vertices, std::span<const std::uint32_t> triangles,
                        const GridSettings& settings) {
  check_settings(settings);
  if (triangles.size() < 3) throw Error(ErrorKind::invalid_input, "the mesh has no triangles to block anything");
  const Box body = bounds_of(vertices, triangles);
  const Box extent = grid_extent(body, settings.epsilon);
  OcclusionGrid grid;
  grid.size = settings.size;
  grid.low = glm::vec3(extent.low);
  grid.high = glm::vec3(extent.high);
  grid.stretch = static_cast<float>(settings.stretch);
  if (!glm::all(glm::lessThan(grid.low, grid.high)))
    throw Error(ErrorKind::invalid_input, "the mesh has no area: all of its vertices lie on a line or in a point");
  grid.share.resize(grid.samples());
  if (settings.cone) grid.direction.resize(grid.samples());

  Ball ball{glm::vec3(0.5 * (body.low + body.high)), 0};
  for (const std::uint32_t index : triangles)
    ball.radius = std::max(ball.radius, glm::distance(ball.centre, vertices[index]));
  ball.radius *= 1.0001f;
  const Tracer tracer(vertices, triangles);
  const std::vector<std::uint8_t> inside = trace(grid, tracer, ball, settings);
  fill_inside(grid);
  close_solid(grid, inside);
  open_border(grid, settings.border);
  return grid;
}

}  // namespace understory
