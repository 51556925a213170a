#include "host/trace/grid_cache.hpp"

#include <cstring>

#include "host/trace/bake_cache.hpp"

namespace understory {
namespace {

/// Raised whenever the same mesh and settings give another grid, or the layout of its bytes changes.
constexpr std::uint32_t version = 4;

ContentHash hash_of(std::span<const glm::vec3> vertices, std::span<const std::uint32_t> triangles,
                    const GridSettings& settings) {
  ContentHash hash;
  hash.add(version);
  hash.add(vertices);
  hash.add(triangles);
  hash.add(std::span<const std::uint32_t>(settings.size));
  hash.add(settings.epsilon);
  hash.add(settings.stretch);
  hash.add(settings.rays);
  hash.add(settings.seed);
  hash.add(static_cast<int>(settings.border));
  hash.add(settings.cone);
  return hash;
}

/// Calls `visit` with each block of the grid's numbers, in order.
template <class Grid, class Visit>
void for_each_block(Grid& grid, const Visit& visit) {
  visit(&grid.low, sizeof(grid.low));
  visit(&grid.high, sizeof(grid.high));
  visit(&grid.border, sizeof(grid.border));
  visit(&grid.stretch, sizeof(grid.stretch));
  visit(grid.share.data(), grid.share.size() * sizeof(grid.share[0]));
  visit(grid.direction.data(), grid.direction.size() * sizeof(glm::vec3));
}

std::string bytes_of(const OcclusionGrid& grid) {
  std::string bytes;
  for_each_block(grid, [&](const void* from, std::size_t size) { bytes.append(static_cast<const char*>(from), size); });
  return bytes;
}

}  // namespace

OcclusionGrid cached_grid(std::span<const glm::vec3> vertices, std::span<const std::uint32_t> triangles,
                          const GridSettings& settings) {
  check_settings(settings);
  const ContentHash hash = hash_of(vertices, triangles, settings);
  if (const std::optional<std::string> bytes = load_bake("grid", hash)) {
    OcclusionGrid grid;
    grid.size = settings.size;
    grid.share.resize(grid.samples());
    if (settings.cone) grid.direction.resize(grid.samples());
    std::size_t expected = 0;
    for_each_block(grid, [&](void*, std::size_t size) { expected += size; });
    if (bytes->size() == expected) {
      const char* from = bytes->data();
      for_each_block(grid, [&](void* to, std::size_t size) { std::memcpy(to, from, size), from += size; });
      return grid;
    }
  }
  OcclusionGrid grid = bake_grid(vertices, triangles, settings);
  store_bake("grid", hash, bytes_of(grid));
  return grid;
}

}  // namespace understory
