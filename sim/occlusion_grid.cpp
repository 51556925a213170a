#include "sim/occlusion_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/error.hpp"

namespace understory {
namespace {

/// Shares above this are all of the sphere: 256 rays and more, all blocked.
constexpr float everything = 1 - 1e-6f;

std::size_t index_of(const GridSize& size, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return (std::size_t(z) * size[1] + y) * size[0] + x;
}

template <class Visit>
void for_each_sample(const GridSize& size, const Visit& visit) {
  for (std::uint32_t z = 0; z < size[2]; ++z)
    for (std::uint32_t y = 0; y < size[1]; ++y)
      for (std::uint32_t x = 0; x < size[0]; ++x) visit(x, y, z, index_of(size, x, y, z));
}

bool on_face(const GridSize& size, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return x == 0 || y == 0 || z == 0 || x + 1 == size[0] || y + 1 == size[1] || z + 1 == size[2];
}

void scale_sample(OcclusionGrid& grid, std::size_t i, float factor) {
  grid.share[i] *= factor;
  if (grid.has_direction()) grid.direction[i] *= factor;
}

void rescale(OcclusionGrid& grid) {
  float most = 0;
  for_each_sample(grid.size, [&](auto x, auto y, auto z, std::size_t i) {
    if (on_face(grid.size, x, y, z)) most = std::max(most, grid.share[i]);
  });
  grid.border = most;
  for (std::size_t i = 0; i < grid.samples(); ++i) {
    const float left = most < 1 ? std::max((grid.share[i] - most) / (1 - most), 0.0f) : 0;
    scale_sample(grid, i, grid.share[i] > 0 ? left / grid.share[i] : 0);
  }
}

/// 0 on the border, 1 from 1/16 of the grid's edges on: two of 32 samples.
float fade_weight(const OcclusionGrid& grid, const glm::vec3& p) {
  const glm::vec3 nearest = glm::min(p - grid.low, grid.high - p) / (grid.high - grid.low);
  return glm::clamp(16 * std::min({nearest.x, nearest.y, nearest.z}), 0.0f, 1.0f);
}

void fade(OcclusionGrid& grid) {
  for_each_sample(grid.size, [&](auto x, auto y, auto z, std::size_t i) {
    scale_sample(grid, i, on_face(grid.size, x, y, z) ? 0 : fade_weight(grid, grid.position(x, y, z)));
  });
}

/// 255 only for all of the sphere.
std::uint8_t share_byte(float share) {
  if (share >= everything) return 255;
  return static_cast<std::uint8_t>(std::min(std::lround(std::max(share, 0.0f) * 255), 254l));
}
std::uint8_t snorm8(float value) {
  return static_cast<std::uint8_t>(128 + std::lround(std::clamp(value, -1.0f, 1.0f) * 127));
}

}  // namespace

glm::vec3 OcclusionGrid::position(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
  const glm::vec3 last(static_cast<float>(size[0] - 1), static_cast<float>(size[1] - 1),
                       static_cast<float>(size[2] - 1));
  const glm::vec3 part = glm::vec3(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)) / last;
  if (stretch == 0) return low + (high - low) * part;
  const glm::vec3 s = 2.0f * part - 1.0f;
  return 0.5f * (low + high) + 0.5f * (high - low) * s / (1.0f + stretch * (1.0f - glm::abs(s)));
}

OccludedDirections occluded_at(const OcclusionGrid& grid, glm::dvec3 position) {
  std::uint32_t first[3];
  double part[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double low = grid.low[axis], high = grid.high[axis], last = grid.size[axis] - 1;
    const double u = (2 * position[axis] - low - high) / (high - low), more = grid.stretch;
    const double at = 0.5 * (1 + u * (1 + more) / (1 + more * std::abs(u))) * last;
    if (!(std::abs(u) <= 1)) return {};
    first[axis] = static_cast<std::uint32_t>(std::min(std::floor(at), last - 1));
    part[axis] = at - first[axis];
  }
  double share = 0;
  glm::dvec3 direction(0);
  for (std::uint32_t corner = 0; corner < 8; ++corner) {
    const std::uint32_t x = corner & 1u, y = corner >> 1 & 1u, z = corner >> 2;
    const double weight = (x ? part[0] : 1 - part[0]) * (y ? part[1] : 1 - part[1]) * (z ? part[2] : 1 - part[2]);
    const std::size_t i = index_of(grid.size, first[0] + x, first[1] + y, first[2] + z);
    share += weight * double(grid.share[i]);
    if (grid.has_direction()) direction += weight * glm::dvec3(grid.direction[i]);
  }
  return {static_cast<float>(share), glm::vec3(direction)};
}

Box grid_extent(const Box& body, double epsilon) {
  const glm::dvec3 middle = 0.5 * (body.low + body.high), edges = body.high - body.low;
  const glm::dvec3 area(edges.y * edges.z, edges.z * edges.x, edges.x * edges.y);
  const double least = std::max({area.x, area.y, area.z}) / 16;
  Box extent;
  for (int axis = 0; axis < 3; ++axis) {
    const double half = 0.5 * edges[axis] + std::sqrt(std::max(area[axis], least) / (4 * std::numbers::pi * epsilon));
    extent.low[axis] = middle[axis] - half;
    extent.high[axis] = middle[axis] + half;
  }
  return extent;
}

void fill_inside(OcclusionGrid& grid) {
  std::vector<std::size_t> inside;
  std::vector<char> known(grid.samples(), 1);
  for (std::size_t i = 0; i < grid.samples(); ++i)
    if (grid.share[i] >= everything) inside.push_back(i), known[i] = 0;
  while (!inside.empty() && inside.size() < grid.samples()) {
    std::vector<std::size_t> left, filled;
    for (const std::size_t i : inside) {
      const auto x = static_cast<std::int64_t>(i % grid.size[0]),
                 y = static_cast<std::int64_t>(i / grid.size[0] % grid.size[1]);
      const auto z = static_cast<std::int64_t>(i / grid.size[0] / grid.size[1]);
      float share = 0, count = 0;
      glm::vec3 direction(0);
      for (std::int64_t c = std::max<std::int64_t>(z - 1, 0); c <= std::min<std::int64_t>(z + 1, grid.size[2] - 1); ++c)
        for (std::int64_t b = std::max<std::int64_t>(y - 1, 0); b <= std::min<std::int64_t>(y + 1, grid.size[1] - 1);
             ++b)
          for (std::int64_t a = std::max<std::int64_t>(x - 1, 0); a <= std::min<std::int64_t>(x + 1, grid.size[0] - 1);
               ++a) {
            const std::size_t j = index_of(grid.size, static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b),
                                           static_cast<std::uint32_t>(c));
            if (!known[j]) continue;
            share += grid.share[j];
            if (grid.has_direction()) direction += grid.direction[j];
            ++count;
          }
      if (count == 0) {
        left.push_back(i);
        continue;
      }
      grid.share[i] = share / count;
      if (grid.has_direction()) grid.direction[i] = direction / count;
      filled.push_back(i);
    }
    if (filled.empty()) return;
    for (const std::size_t i : filled) known[i] = 1;
    inside = std::move(left);
  }
}

void close_solid(OcclusionGrid& grid, std::span<const std::uint8_t> inside) {
  if (inside.size() != grid.samples()) throw Error(ErrorKind::unexpected, "one flag a sample tells what lies inside");
  const auto surrounded = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    for (std::uint32_t c = z - 1; c <= z + 1; ++c)
      for (std::uint32_t b = y - 1; b <= y + 1; ++b)
        for (std::uint32_t a = x - 1; a <= x + 1; ++a)
          if (!inside[index_of(grid.size, a, b, c)]) return false;
    return true;
  };
  for_each_sample(grid.size, [&](auto x, auto y, auto z, std::size_t i) {
    if (!inside[i] || on_face(grid.size, x, y, z) || !surrounded(x, y, z)) return;
    grid.share[i] = 1;
    if (grid.has_direction()) grid.direction[i] = glm::vec3(0);
  });
}

float faded_from(const OcclusionGrid& grid) {
  float from = 0.875f;
  for (const std::uint32_t size : grid.size) {
    const float s = 1 - 2 / static_cast<float>(size - 1);
    from = std::min(from, s / (1 + grid.stretch * (1 - s)));
  }
  return std::max(from, 0.0f);
}

void open_border(OcclusionGrid& grid, GridBorder how) {
  if (how == GridBorder::rescale)
    rescale(grid);
  else
    fade(grid);
}

std::vector<std::uint8_t> packed_share(const OcclusionGrid& grid) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(grid.samples());
  for (const float share : grid.share) bytes.push_back(share_byte(share));
  return bytes;
}

std::vector<std::uint8_t> packed_cone(const OcclusionGrid& grid) {
  if (!grid.has_direction()) throw Error(ErrorKind::unexpected, "a scalar grid has no cones to pack");
  std::vector<std::uint8_t> bytes;
  bytes.reserve(4 * grid.samples());
  for (std::size_t i = 0; i < grid.samples(); ++i) {
    for (int axis = 0; axis < 3; ++axis) bytes.push_back(snorm8(4 * grid.direction[i][axis]));
    bytes.push_back(share_byte(grid.share[i]));
  }
  return bytes;
}

OcclusionGrid unpacked(const OcclusionGrid& shape, std::span<const std::uint8_t> bytes) {
  OcclusionGrid grid = shape;
  const bool cone = bytes.size() == 4 * shape.samples();
  if (!cone && bytes.size() != shape.samples())
    throw Error(ErrorKind::unexpected, "a packed grid of " + std::to_string(shape.samples()) + " samples has " +
                                           std::to_string(bytes.size()) + " bytes");
  grid.share.assign(shape.samples(), 0);
  grid.direction.assign(cone ? shape.samples() : 0, glm::vec3(0));
  for (std::size_t i = 0; i < shape.samples(); ++i) {
    grid.share[i] = static_cast<float>(bytes[cone ? 4 * i + 3 : i]) / 255;
    if (cone)
      for (int axis = 0; axis < 3; ++axis)
        grid.direction[i][axis] = static_cast<float>(bytes[4 * i + axis] - 128) / (4 * 127.0f);
  }
  return grid;
}

}  // namespace understory
