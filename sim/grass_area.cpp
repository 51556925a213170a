#include "sim/grass_area.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "sim/grass.hpp"
#include "sim/grass_pieces.hpp"
#include "sim/world_builder.hpp"

namespace understory {
namespace {

constexpr double cells_per_height = 32, most_columns = 65536;
constexpr double smallest_cell = 0.015;  // m: in smaller ones blades are no longer scattered at random
constexpr double border = 2;             // in heights of the grass: further away it hides less than 3 % of the sky
constexpr double slab_height = 4.0 / 3;  // in cells, while there are
constexpr double fewest_slabs = 12, most_slabs = 24;

/// What bounds the grass, and how high it stands above the ground.
struct Bounds {
  glm::dvec2 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
  double height = 0;
};

Bounds bounds_of(const World& world, const GroundHeight& ground) {
  Bounds bounds;
  visit_grass(world, std::numeric_limits<double>::infinity(), [&](const GrassPiece& piece) {
    bounds.low = glm::min(bounds.low, glm::dvec2(piece.position));
    bounds.high = glm::max(bounds.high, glm::dvec2(piece.position));
    bounds.height =
        std::max(bounds.height, piece.position.z - ground(glm::dvec2(piece.position)).value_or(piece.position.z));
  });
  return bounds;
}

/// Heights at the middles of the columns; beside the terrain that of its nearest column in the row, else of the datum.
void level_ground(GrassArea& area, const GroundHeight& ground) {
  area.ground.assign(area.column_count(), 0);
  std::vector<std::optional<double>> heights(area.column_count());
  area.datum = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const glm::dvec2 place(double(i % area.columns) + 0.5, double(i / area.columns) + 0.5);
    heights[i] = ground(area.extent.low + area.cell * place);
    if (heights[i]) area.datum = std::min(area.datum, *heights[i]);
  }
  if (!std::isfinite(area.datum)) area.datum = 0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const bool row_starts = i % area.columns == 0;
    area.ground[i] = heights[i] ? static_cast<float>(*heights[i] - area.datum) : row_starts ? 0 : area.ground[i - 1];
  }
}

/// Collects, voxel by voxel, what a blade itself turns to the sky around a place on it.
class OwnBlades {
 public:
  explicit OwnBlades(GrassArea& area) : area_(area), total_(area.projection.size() / sky_rings, 0) {
    area.own.assign(area.projection.size(), 0);
  }
  void add(std::size_t voxel, const GrassPiece& piece, const float* turned) {
    if (piece.blade != blade_) finish_blade();
    blade_ = piece.blade;
    Part& part = parts_[voxel];
    part.area += static_cast<float>(piece.area);
    for (int ring = 0; ring < sky_rings; ++ring) part.turned[ring] += static_cast<float>(piece.area) * turned[ring];
  }
  void finish() {
    finish_blade();
    for (std::size_t i = 0; i < area_.own.size(); ++i)
      if (const float total = total_[i / sky_rings]; total > 0) area_.own[i] /= total;
  }

 private:
  struct Part {
    float area = 0;
    std::array<float, sky_rings> turned{};
  };
  void finish_blade() {
    for (const auto& [voxel, part] : parts_) {
      total_[voxel] += part.area;
      for (int ring = 0; ring < sky_rings; ++ring)
        area_.own[voxel * sky_rings + std::size_t(ring)] += part.area * part.turned[std::size_t(ring)];
    }
    parts_.clear();
  }

  GrassArea& area_;
  std::vector<float> total_;           // area in each voxel, m^2
  std::map<std::size_t, Part> parts_;  // of the blade that is being visited, by voxel
  std::uint32_t blade_ = 0;
};

}  // namespace

double mean_projection(double normal_cosine, double direction_cosine) {
  const double n = std::min(std::abs(normal_cosine), 1.0), w = std::min(std::abs(direction_cosine), 1.0);
  const double steady = n * w, swing = std::sqrt((1 - n * n) * (1 - w * w));
  if (steady >= swing) return steady;
  const double turn = std::acos(-steady / swing);  // where n.w changes sign
  return 2 / std::numbers::pi * (steady * (turn - std::numbers::pi / 2) + swing * std::sin(turn));
}

GrassArea measure_grass(const World& world) {
  const GroundHeight ground = ground_of(world);
  const Bounds bounds = bounds_of(world, ground);
  GrassArea area;
  if (!(bounds.height > 0)) return area;
  const glm::dvec2 edges = bounds.high - bounds.low + 2 * border * bounds.height;
  area.cell = std::max({bounds.height / cells_per_height, smallest_cell, std::sqrt(edges.x * edges.y / most_columns)});
  const glm::dvec2 cells = glm::ceil(edges / area.cell);
  area.columns = static_cast<std::uint32_t>(cells.x);
  area.rows = static_cast<std::uint32_t>(cells.y);
  const double slabs = std::round(bounds.height / (slab_height * area.cell));
  area.slabs = static_cast<std::uint32_t>(std::clamp(slabs, fewest_slabs, most_slabs));
  area.slab = bounds.height / area.slabs;
  const glm::dvec2 middle = 0.5 * (bounds.low + bounds.high);
  area.extent = {middle - 0.5 * area.cell * cells, middle + 0.5 * area.cell * cells};
  level_ground(area, ground);

  constexpr int tilts = 64;
  float turned[tilts + 1][sky_rings];  // area turned to each ring per area and volume of a voxel
  for (int tilt = 0; tilt <= tilts; ++tilt)
    for (int ring = 0; ring < sky_rings; ++ring)
      turned[tilt][ring] = static_cast<float>(mean_projection(double(tilt) / tilts, ring_cosine(ring)) /
                                              (area.cell * area.cell * area.slab));
  area.projection.assign(area.slabs * area.column_count() * sky_rings, 0);
  OwnBlades own(area);
  visit_grass(world, area.cell / 2, [&](const GrassPiece& piece) {
    const glm::dvec2 place = (glm::dvec2(piece.position) - area.extent.low) / area.cell;
    const auto column = static_cast<std::size_t>(std::clamp(place.x, 0.0, cells.x - 1));
    const auto row = static_cast<std::size_t>(std::clamp(place.y, 0.0, cells.y - 1));
    const double above = piece.position.z - area.datum - double(area.ground[row * area.columns + column]);
    const auto slab = static_cast<std::size_t>(std::clamp(above / area.slab, 0.0, area.slabs - 1.0));
    const auto tilt = static_cast<std::size_t>(std::lround(std::min(std::abs(piece.normal_cosine), 1.0) * tilts));
    const std::size_t voxel = (slab * area.rows + row) * area.columns + column;
    for (int ring = 0; ring < sky_rings; ++ring)
      area.projection[voxel * sky_rings + std::size_t(ring)] += static_cast<float>(piece.area) * turned[tilt][ring];
    own.add(voxel, piece, turned[tilt]);
  });
  own.finish();
  return area;
}

}  // namespace understory
