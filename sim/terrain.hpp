// The ground: flat, from a height raster, or from a mesh. Heights are those of the triangles that are drawn, so that
// nothing floats above or sinks below what one sees. Metres relative to the scene's origin, z up.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "sim/prototype.hpp"
#include "sim/scene.hpp"

namespace understory {

class Terrain {
 public:
  /// A level rectangle, as a grid of cells of about 4 m (at most 64 a side).
  static Terrain flat(const Region& extent, double height);
  /// Node heights, row-major with y up, evenly spaced over `extent`; at least 2 by 2. Two triangles a cell.
  static Terrain from_grid(const Region& extent, std::uint32_t columns, std::uint32_t rows,
                           const std::vector<float>& heights);
  /// Any triangles; where several lie above each other the highest is the ground.
  static Terrain from_mesh(RawMesh mesh);

  /// Height of the surface, m; nothing beyond its border or in a hole.
  std::optional<double> surface_at(glm::dvec2 at) const;
  /// Height of the surface, m; beyond its border that of the nearest point of the bounding rectangle, in a hole that of
  /// the nearest vertex. For bodies that pass the border; plants and blades are only put where there is a surface.
  double height_at(glm::dvec2 at) const;
  const RawMesh& mesh() const { return mesh_; }
  /// Bounding rectangle.
  const Region& extent() const { return extent_; }

 private:
  explicit Terrain(RawMesh mesh);
  void index_triangles();
  glm::ivec2 cell_of(glm::dvec2 at) const;

  RawMesh mesh_;
  Region extent_;
  // Triangles whose rectangles touch a cell: candidate_[first_[cell]] .. candidate_[first_[cell + 1] - 1].
  glm::ivec2 cells_{1};
  glm::dvec2 cells_per_metre_{0};
  std::vector<std::uint32_t> first_, candidate_;
  std::vector<glm::vec3> corners_;  // 3 per triangle, all parts
};

/// Reads what a scene names and moves it to its place. Rasters of more than 1024 nodes a side are resampled to that
/// many. Throws Error naming the file.
Terrain read_terrain(const TerrainSource& source);

}  // namespace understory
