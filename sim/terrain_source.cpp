// From what a scene file names to the ground itself.
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/files/mesh.hpp"
#include "sim/files/raster.hpp"
#include "sim/terrain.hpp"

namespace understory {
namespace {

constexpr std::uint32_t most_nodes = 1024;  // a side; two million triangles

/// Bilinear, clamped; `at` in samples.
float height_between(const HeightRaster& raster, glm::dvec2 at) {
  const auto corner = glm::min(glm::dvec2(raster.columns - 2, raster.rows - 2), glm::floor(at));
  const auto column = static_cast<std::uint32_t>(corner.x), row = static_cast<std::uint32_t>(corner.y);
  const glm::vec2 part(at - corner);
  return glm::mix(glm::mix(raster.at(column, row), raster.at(column + 1, row), part.x),
                  glm::mix(raster.at(column, row + 1), raster.at(column + 1, row + 1), part.x), part.y);
}

Terrain from_raster(const HeightRaster& raster, const TerrainSource& source) {
  const std::uint32_t columns = std::min(raster.columns, most_nodes), rows = std::min(raster.rows, most_nodes);
  const glm::dvec2 stride = glm::dvec2(raster.columns - 1, raster.rows - 1) / glm::dvec2(columns - 1, rows - 1);
  std::vector<float> heights;
  heights.reserve(std::size_t(columns) * rows);
  for (std::uint32_t row = 0; row < rows; ++row)
    for (std::uint32_t column = 0; column < columns; ++column)
      heights.push_back(height_between(raster, stride * glm::dvec2(column, row)) + static_cast<float>(source.height));
  const Region there = raster.extent();
  const glm::dvec2 half = (there.high - there.low) / 2.0;
  return Terrain::from_grid({source.centre - half, source.centre + half}, columns, rows, heights);
}

Terrain from_mesh_file(const TerrainSource& source) {
  RawMesh mesh = read_mesh(source.file, source.up);
  glm::vec3 low(std::numeric_limits<float>::infinity()), high = -low;
  for (const RawMesh::Part& part : mesh.parts)
    for (const glm::vec3& position : part.positions) {
      low = glm::min(low, position);
      high = glm::max(high, position);
    }
  const glm::dvec3 shift(source.centre - glm::dvec2(low + high) / 2.0, source.height);
  for (RawMesh::Part& part : mesh.parts)
    for (glm::vec3& position : part.positions) position = glm::vec3(glm::dvec3(position) + shift);
  return Terrain::from_mesh(std::move(mesh));
}

}  // namespace

Terrain read_terrain(const TerrainSource& source) {
  switch (source.kind) {
    case TerrainSource::Kind::raster:
      return from_raster(read_height_raster(source.file), source);
    case TerrainSource::Kind::mesh:
      return from_mesh_file(source);
    case TerrainSource::Kind::flat:
      break;
  }
  return Terrain::flat(source.extent, source.height);
}

}  // namespace understory
