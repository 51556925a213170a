// Light is carried through the slabs, direction by direction: a node sees the sky where its ray leaves the slab, dimmed
// by the blades on the way. So a direction costs a few steps a node, however thick or wide the layer is.
#include "sim/grass_layer.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace understory {
namespace {

constexpr int azimuths = 8;

/// One direction of the sky and what light from it adds to each number of LayerLight.
struct SkyDirection {
  glm::dvec2 lean{0};  // horizontal way per height gained
  int ring = 0;
  bool up = true;
  LayerLight share;
};

/// Least squares over all normals of V(n) = weight max(n.w, 0)/pi by the terms of LayerLight, on a product grid: there
/// the terms in x and y stand at right angles to the others.
class LightFit {
 public:
  explicit LightFit(bool open_below) : open_below_(open_below) {
    glm::dmat3 gram(0);
    each_normal([&](glm::dvec3 n) {
      const glm::dvec3 t = zonal(n.z);
      gram += glm::outerProduct(t, t);
      sideways_ += n.x * n.x;
    });
    if (!open_below) gram[2][2] = 1;
    solve_ = glm::inverse(gram);
  }

  LayerLight of(glm::dvec3 w, double weight) const {
    glm::dvec3 vertical(0);
    glm::dvec2 horizontal(0);
    each_normal([&](glm::dvec3 n) {
      const double v = weight * std::max(glm::dot(n, w), 0.0) / std::numbers::pi;
      vertical += v * zonal(n.z);
      horizontal += v * glm::dvec2(n);
    });
    vertical = solve_ * vertical;
    horizontal /= sideways_;
    return {float(vertical.x), float(vertical.y), float(horizontal.x), float(horizontal.y), float(vertical.z)};
  }

 private:
  glm::dvec3 zonal(double z) const { return {1 + z, (1 + z) * z, open_below_ ? 1 - z : 0}; }

  template <class Visit>
  static void each_normal(const Visit& visit) {
    constexpr int heights = 32, turns = 32;
    for (int i = 0; i < heights; ++i)
      for (int j = 0; j < turns; ++j) {
        const double z = 2 * (i + 0.5) / heights - 1, flat = std::sqrt(1 - z * z);
        const double turn = 2 * std::numbers::pi * j / turns;
        visit(glm::dvec3(flat * std::cos(turn), flat * std::sin(turn), z));
      }
  }

  bool open_below_;
  glm::dmat3 solve_{1};
  double sideways_ = 0;
};

std::vector<SkyDirection> sky_directions(bool open_below) {
  const LightFit fit(open_below);
  std::vector<SkyDirection> all;
  for (const double side : {1.0, -1.0})
    for (int ring = 0; ring < (side > 0 || open_below ? sky_rings : 0); ++ring)
      for (int k = 0; k < azimuths; ++k) {
        const double cosine = ring_cosine(ring), sine = std::sqrt(1 - cosine * cosine);
        const double turn = 2 * std::numbers::pi * (k + 0.5) / azimuths;
        const glm::dvec2 flat = sine * glm::dvec2(std::cos(turn), std::sin(turn));
        all.push_back({flat / cosine, ring, side > 0,
                       fit.of(glm::dvec3(flat, side * cosine), 2 * std::numbers::pi / (sky_rings * azimuths))});
      }
  return all;
}

LayerLight added(const LayerLight& a, const LayerLight& b, float share) {
  return {a.above + share * b.above, a.zenith + share * b.zenith, a.x + share * b.x, a.y + share * b.y,
          a.below + share * b.below};
}

/// The finite set of directions leaves a little of the fit's error: an open sky must come out open.
void calibrate(std::vector<SkyDirection>& directions) {
  LayerLight open{0, 0, 0, 0, 0};
  for (const SkyDirection& direction : directions) open = added(open, direction.share, 1);
  for (SkyDirection& direction : directions) {
    LayerLight& share = direction.share;
    share.zenith -= share.above * open.zenith / open.above;
    share.above *= 0.5f / open.above;
    if (open.below > 0) share.below *= 0.5f / open.below;
  }
}

/// One level of transmittances, bilinear between the columns' middles and open beside the grid.
class OpenPlane {
 public:
  OpenPlane(const GrassArea& area) : columns_(int(area.columns)), rows_(int(area.rows)) {
    values_.assign(area.column_count(), 1);
  }
  float& at(int column, int row) { return values_[std::size_t(row) * columns_ + column]; }
  float get(int column, int row) const {
    const bool within = column >= 0 && row >= 0 && column < columns_ && row < rows_;
    return within ? values_[std::size_t(row) * columns_ + column] : 1;
  }
  float between(float x, float y) const {
    const float left = std::floor(x), low = std::floor(y), right = x - left, up = y - low;
    const int i = int(left), j = int(low);
    return (1 - up) * ((1 - right) * get(i, j) + right * get(i + 1, j)) +
           up * ((1 - right) * get(i, j + 1) + right * get(i + 1, j + 1));
  }

 private:
  int columns_, rows_;
  std::vector<float> values_;
};

/// The way of one direction's rays through a slab, the same for every node of a level.
struct SlabPath {
  SlabPath(const GrassArea& area, const SkyDirection& direction)
      : steps(std::max(1, int(std::ceil(glm::length(direction.lean) * area.slab / area.cell)))),
        offset(glm::vec2(direction.lean * (area.slab / area.cell))),
        length(float(area.slab / ring_cosine(direction.ring) / steps)) {}
  int steps;
  glm::vec2 offset;  // cells, from the slab's one side to the other
  float length;      // m, of a step
};

float optical_depth(const GrassArea& area, std::uint32_t slab, int ring, const SlabPath& path, int column, int row) {
  float sum = 0;
  for (int step = 0; step < path.steps; ++step) {
    const glm::vec2 at = glm::vec2(column, row) + 0.5f + path.offset * ((float(step) + 0.5f) / float(path.steps));
    if (at.x < 0 || at.y < 0) continue;
    const auto i = std::size_t(at.x), j = std::size_t(at.y);
    if (i < area.columns && j < area.rows)
      sum += area.projection[((slab * area.rows + j) * area.columns + i) * sky_rings + std::size_t(ring)];
  }
  return sum * path.length;
}

/// Of optical_depth, what does not count for a place on a blade around the node: its own blade, in the node's column.
float own_depth(const GrassArea& area, std::uint32_t slab, int ring, const SlabPath& path, int column, int row) {
  if (area.own.empty()) return 0;
  int steps = 0;
  for (; steps < path.steps; ++steps) {
    const glm::vec2 at = glm::abs(path.offset * ((float(steps) + 0.5f) / float(path.steps)));
    if (at.x > 0.5f || at.y > 0.5f) break;
  }
  const std::size_t voxel = (std::size_t{slab} * area.rows + std::size_t(row)) * area.columns + std::size_t(column);
  return float(steps) * path.length * area.own[voxel * sky_rings + std::size_t(ring)];
}

void add_direction(const GrassArea& area, const SkyDirection& direction, GrassLayer& layer) {
  const SlabPath path(area, direction);
  OpenPlane far(area), near(area);
  for (std::uint32_t k = 0; k < layer.levels; ++k) {
    const std::uint32_t level = direction.up ? layer.levels - 1 - k : k;
    tbb::parallel_for(0, int(area.rows), [&](int row) {
      for (int column = 0; column < int(area.columns); ++column) {
        float open = 1, from_blade = 1;
        if (k > 0) {
          const std::uint32_t slab = direction.up ? level : level - 1;
          open = from_blade = far.between(float(column) + path.offset.x, float(row) + path.offset.y);
          if (const float depth = optical_depth(area, slab, direction.ring, path, column, row); depth > 0) {
            const float own = level > 0 ? own_depth(area, slab, direction.ring, path, column, row) : 0;
            from_blade *= std::exp(std::min(own - depth, 0.0f));
            open *= std::exp(-depth);
          }
        }
        near.at(column, row) = open;
        LayerLight& light = layer.light[(std::size_t(row) * area.columns + column) * layer.levels + level];
        light = added(light, direction.share, from_blade);
      }
    });
    std::swap(far, near);
  }
}

/// Beside the grid the model ends: its border is open, so that nothing jumps there.
void open_border(GrassLayer& layer, bool open_below) {
  const LayerLight open{0.5f, 0, 0, 0, open_below ? 0.5f : 0};
  for (std::uint32_t row = 0; row < layer.rows; ++row)
    for (std::uint32_t column = 0; column < layer.columns; ++column)
      if (row == 0 || column == 0 || row + 1 == layer.rows || column + 1 == layer.columns)
        std::fill_n(layer.light.begin() + std::ptrdiff_t((std::size_t(row) * layer.columns + column) * layer.levels),
                    layer.levels, open);
}

}  // namespace

GrassLayer light_grass(const GrassArea& area, bool open_below) {
  GrassLayer layer;
  if (area.columns == 0) return layer;
  layer.extent = area.extent;
  layer.columns = area.columns;
  layer.rows = area.rows;
  layer.levels = area.slabs + 1;
  layer.level_height = area.slab;
  layer.datum = area.datum;
  layer.ground = area.ground;
  layer.light.assign(area.column_count() * layer.levels, LayerLight{0, 0, 0, 0, 0});
  std::vector<SkyDirection> directions = sky_directions(open_below);
  calibrate(directions);
  for (const SkyDirection& direction : directions) add_direction(area, direction, layer);
  open_border(layer, open_below);
  return layer;
}

bool open_below_grass(const World& world) { return world.scene.sky == Sky::sphere && !world.scene.has_terrain; }

GrassLayer light_grass(const World& world) { return light_grass(measure_grass(world), open_below_grass(world)); }

}  // namespace understory
