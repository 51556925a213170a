#include "sim/terrain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/error.hpp"

namespace understory {
namespace {

std::uint32_t flat_cells(double edge) { return static_cast<std::uint32_t>(std::clamp(std::ceil(edge / 4), 1.0, 64.0)); }

/// Height of a triangle over a point; nothing beside it. The margin closes the seams between neighbours.
std::optional<double> height_on(const glm::vec3* corner, glm::dvec2 at) {
  const glm::dvec3 a(corner[0]), b(corner[1]), c(corner[2]);
  const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
  if (area == 0) return std::nullopt;
  const double to_b = ((at.x - a.x) * (c.y - a.y) - (c.x - a.x) * (at.y - a.y)) / area;
  const double to_c = ((b.x - a.x) * (at.y - a.y) - (at.x - a.x) * (b.y - a.y)) / area;
  constexpr double margin = 1e-9;
  if (!(to_b >= -margin && to_c >= -margin && to_b + to_c <= 1 + margin)) return std::nullopt;
  return a.z + to_b * (b.z - a.z) + to_c * (c.z - a.z);
}

}  // namespace

Terrain Terrain::flat(const Region& extent, double height) {
  const std::uint32_t columns = flat_cells(extent.high.x - extent.low.x) + 1;
  const std::uint32_t rows = flat_cells(extent.high.y - extent.low.y) + 1;
  return from_grid(extent, columns, rows, std::vector<float>(columns * rows, static_cast<float>(height)));
}

Terrain Terrain::from_grid(const Region& extent, std::uint32_t columns, std::uint32_t rows,
                           const std::vector<float>& heights) {
  if (columns < 2 || rows < 2 || heights.size() != std::size_t(columns) * rows)
    throw Error(ErrorKind::invalid_input,
                fmt::format("terrain: {} heights for a grid of {} by {} nodes (at least 2 by 2, one height a node)",
                            heights.size(), columns, rows));
  RawMesh::Part part{"terrain", "terrain", SurfaceClass::terrain, {}, {}};
  part.positions.reserve(heights.size());
  const glm::dvec2 step = (extent.high - extent.low) / glm::dvec2(columns - 1, rows - 1);
  for (std::uint32_t row = 0; row < rows; ++row)
    for (std::uint32_t column = 0; column < columns; ++column)
      part.positions.emplace_back(glm::vec2(extent.low + step * glm::dvec2(column, row)),
                                  heights[std::size_t(row) * columns + column]);
  part.triangles.reserve(std::size_t(columns - 1) * (rows - 1) * 6);
  for (std::uint32_t row = 0; row + 1 < rows; ++row)
    for (std::uint32_t column = 0; column + 1 < columns; ++column) {
      const std::uint32_t v = row * columns + column;
      for (std::uint32_t corner : {v, v + 1, v + columns + 1, v, v + columns + 1, v + columns})
        part.triangles.push_back(corner);
    }
  return Terrain(RawMesh{{std::move(part)}});
}

Terrain Terrain::from_mesh(RawMesh mesh) {
  for (RawMesh::Part& part : mesh.parts) part.surface = SurfaceClass::terrain;
  return Terrain(std::move(mesh));
}

Terrain::Terrain(RawMesh mesh) : mesh_(std::move(mesh)) {
  for (const RawMesh::Part& part : mesh_.parts)
    for (std::uint32_t vertex : part.triangles) corners_.push_back(part.positions.at(vertex));
  if (corners_.empty()) throw Error(ErrorKind::invalid_input, "terrain: a mesh without triangles is no ground");
  extent_ = {glm::dvec2(std::numeric_limits<double>::infinity()), glm::dvec2(-std::numeric_limits<double>::infinity())};
  for (const glm::vec3& corner : corners_) {
    extent_.low = glm::min(extent_.low, glm::dvec2(corner));
    extent_.high = glm::max(extent_.high, glm::dvec2(corner));
  }
  if (!(extent_.area() > 0 && std::isfinite(extent_.area())))
    throw Error(ErrorKind::invalid_input, "terrain: the mesh covers no ground (is `up` right?)");
  index_triangles();
}

glm::ivec2 Terrain::cell_of(glm::dvec2 at) const {
  const glm::dvec2 cell = glm::floor((at - extent_.low) * cells_per_metre_);
  return glm::ivec2(glm::clamp(cell, glm::dvec2(0), glm::dvec2(cells_ - 1)));
}

void Terrain::index_triangles() {
  const double per_cell = std::sqrt(2 * extent_.area() / double(corners_.size() / 3));  // two triangles a cell
  const glm::dvec2 edges = extent_.high - extent_.low;
  cells_ = glm::ivec2(glm::clamp(glm::ceil(edges / per_cell), glm::dvec2(1), glm::dvec2(4096)));
  cells_per_metre_ = glm::dvec2(cells_) / edges;
  const auto for_each_cell = [&](std::size_t triangle, auto&& visit) {
    const glm::vec3* corner = &corners_[3 * triangle];
    const glm::ivec2 low = cell_of(glm::dvec2(glm::min(corner[0], glm::min(corner[1], corner[2]))));
    const glm::ivec2 high = cell_of(glm::dvec2(glm::max(corner[0], glm::max(corner[1], corner[2]))));
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x) visit(std::size_t(y) * cells_.x + x);
  };
  first_.assign(std::size_t(cells_.x) * cells_.y + 1, 0);
  const std::size_t triangles = corners_.size() / 3;
  for (std::size_t t = 0; t < triangles; ++t) for_each_cell(t, [&](std::size_t cell) { ++first_[cell + 1]; });
  for (std::size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
  candidate_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t t = 0; t < triangles; ++t)
    for_each_cell(t, [&](std::size_t cell) { candidate_[next[cell]++] = static_cast<std::uint32_t>(t); });
}

std::optional<double> Terrain::surface_at(glm::dvec2 at) const {
  if (!extent_.contains(at)) return std::nullopt;
  const glm::ivec2 place = cell_of(at);
  const std::size_t cell = std::size_t(place.y) * cells_.x + place.x;
  std::optional<double> highest;
  for (std::uint32_t entry = first_[cell]; entry < first_[cell + 1]; ++entry)
    if (const auto height = height_on(&corners_[3 * std::size_t(candidate_[entry])], at))
      highest = std::max(highest.value_or(*height), *height);
  return highest;
}

double Terrain::height_at(glm::dvec2 at) const {
  const glm::dvec2 inside = glm::clamp(at, extent_.low, extent_.high);
  if (const auto height = surface_at(inside)) return *height;
  const auto distance = [&](const glm::vec3& corner) {
    const glm::dvec2 offset = glm::dvec2(corner) - inside;
    return glm::dot(offset, offset);
  };
  return std::min_element(corners_.begin(), corners_.end(),
                          [&](const auto& a, const auto& b) { return distance(a) < distance(b); })
      ->z;
}

}  // namespace understory
