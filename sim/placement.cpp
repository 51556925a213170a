#include "sim/placement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/error.hpp"
#include "sim/random.hpp"

namespace understory {
namespace {

constexpr double most_cells = 1e8;  // of the grid below: 400 MB

/// At most one point a cell: cells are so small that two points of one cell would be too close.
class PointGrid {
 public:
  PointGrid(const Region& region, double spacing)
      : region_(region), spacing_(spacing), cell_(spacing / std::numbers::sqrt2) {
    const glm::dvec2 cells = glm::floor((region.high - region.low) / cell_) + 1.0;
    if (!(cells.x * cells.y <= most_cells))
      throw Error(ErrorKind::invalid_input,
                  fmt::format("scatter: spacing {:g} m is too small for a region of {:g} m by {:g} m", spacing,
                              region.high.x - region.low.x, region.high.y - region.low.y));
    cells_ = glm::ivec2(cells);
    point_.assign(std::size_t(cells_.x) * cells_.y, -1);
  }

  bool has_room(glm::dvec2 at) const {
    const glm::ivec2 centre = cell_of(at);
    const glm::ivec2 low = glm::max(centre - 2, glm::ivec2(0)), high = glm::min(centre + 2, cells_ - 1);
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x)
        if (const int other = point_[std::size_t(y) * cells_.x + x]; other >= 0) {
          const glm::dvec2 apart = points_[other] - at;
          if (glm::dot(apart, apart) < spacing_ * spacing_) return false;
        }
    return true;
  }

  void add(glm::dvec2 at) {
    const glm::ivec2 cell = cell_of(at);
    point_[std::size_t(cell.y) * cells_.x + cell.x] = static_cast<int>(points_.size());
    points_.push_back(at);
  }

  const std::vector<glm::dvec2>& points() const { return points_; }

 private:
  glm::ivec2 cell_of(glm::dvec2 at) const {
    return glm::clamp(glm::ivec2((at - region_.low) / cell_), glm::ivec2(0), cells_ - 1);
  }

  Region region_;
  double spacing_, cell_;
  glm::ivec2 cells_{0};
  std::vector<int> point_;  // index in points_; -1: empty
  std::vector<glm::dvec2> points_;
};

/// Uniform over the ring between radius 1 and 2. By rejection: no library function that differs between machines.
glm::dvec2 in_ring(Random& random) {
  for (;;) {
    const double x = random.uniform(-2, 2), y = random.uniform(-2, 2);
    const double square = x * x + y * y;
    if (square >= 1 && square < 4) return {x, y};
  }
}

}  // namespace

std::vector<glm::dvec2> scatter(const Region& region, double spacing, std::uint64_t seed, std::uint64_t stream,
                                const Admissible& admissible) {
  PointGrid grid(region, spacing);
  Random random(seed, stream);
  std::vector<std::size_t> active;
  const auto grow_from = [&](glm::dvec2 at) {
    if (!region.contains(at) || !grid.has_room(at) || !admissible(at)) return false;
    active.push_back(grid.points().size());
    grid.add(at);
    return true;
  };
  // Several starts, so that pieces of ground that do not touch each get plants.
  for (int start = 0; start < 64; ++start) {
    const double x = random.uniform(region.low.x, region.high.x), y = random.uniform(region.low.y, region.high.y);
    grow_from({x, y});
    while (!active.empty()) {
      const std::size_t chosen = random.below(active.size());
      const glm::dvec2 around = grid.points()[active[chosen]];
      bool found = false;
      for (int trial = 0; trial < 30 && !found; ++trial) {
        found = grow_from(around + spacing * in_ring(random));
      }
      if (!found) {
        active[chosen] = active.back();
        active.pop_back();
      }
    }
  }
  return grid.points();
}

std::vector<PlacedPlant> place(const PlantPlacement& placement, std::uint64_t seed, std::uint64_t stream,
                               const Admissible& admissible) {
  std::vector<PlacedPlant> plants;
  if (placement.scatter) {
    std::vector<glm::dvec2> points = scatter(placement.region, placement.spacing, seed, stream, admissible);
    const std::size_t wanted = placement.count > 0 ? std::size_t(placement.count) : points.size();
    if (points.size() < wanted || points.empty())
      throw Error(
          ErrorKind::invalid_input,
          fmt::format("plants: only {} of {} `{}` fit into the scatter's region at spacing {:g} m: lower `count` "
                      "or `spacing`, or widen the region or the terrain",
                      points.size(), std::max<std::size_t>(wanted, 1), placement.species, placement.spacing));
    // A random choice keeps the spacing and is spread over the whole region, unlike the first points found.
    Random choice(seed, mix_bits(stream));
    for (std::size_t i = 0; i < wanted; ++i) std::swap(points[i], points[i + choice.below(points.size() - i)]);
    for (std::size_t i = 0; i < wanted; ++i) {
      Random random(seed, stream, i + 1);
      const double yaw = random.uniform(0, 2 * std::numbers::pi);
      plants.push_back({points[i], yaw, random.uniform(placement.scale[0], placement.scale[1]), 0});
    }
  } else {
    for (const PlantPlacement::Spot& spot : placement.spots) {
      if (!admissible(spot.at))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("plants: `{}` at [{:g}, {:g}] stands beside the terrain: move it or widen the terrain",
                                placement.species, spot.at.x, spot.at.y));
      plants.push_back({spot.at, spot.yaw, spot.scale, 0});
    }
  }
  for (std::size_t i = 0; i < plants.size(); ++i)
    plants[i].delay = Random(seed, stream_of("delay", stream), i).uniform(0, longest_plant_delay);
  return plants;
}

}  // namespace understory
