#include "sim/grass.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/error.hpp"
#include "sim/random.hpp"

namespace understory {
namespace {

constexpr double blades_per_tile = 51;  // five triangles each: a chunk of 256 triangles
constexpr double blades_per_tuft = 20;
constexpr double tuft_radius = 0.25;  // deviation of a blade from its tuft's centre, in units of the tufts' distance

/// Bits of a 16-bit number spread to even places: x and y interleaved are a place on the Z-order curve.
std::uint32_t spread_bits(std::uint32_t value) {
  value = (value | (value << 8)) & 0x00ff00ffu;
  value = (value | (value << 4)) & 0x0f0f0f0fu;
  value = (value | (value << 2)) & 0x33333333u;
  return (value | (value << 1)) & 0x55555555u;
}

/// A region cut into near-square tiles, listed along the Z-order curve.
struct Tiling {
  Region region;
  glm::ivec2 tiles{1};
  std::vector<glm::ivec2> order;
  glm::dvec2 size() const { return (region.high - region.low) / glm::dvec2(tiles); }
};

Tiling tile(const Region& region, double blades) {
  const glm::dvec2 edges = region.high - region.low;
  const double edge = std::sqrt(region.area() * blades_per_tile / std::max(blades, blades_per_tile));
  Tiling tiling{region, glm::ivec2(glm::clamp(glm::round(edges / edge), glm::dvec2(1), glm::dvec2(32768))), {}};
  std::vector<std::pair<std::uint32_t, glm::ivec2>> keyed;
  for (int y = 0; y < tiling.tiles.y; ++y)
    for (int x = 0; x < tiling.tiles.x; ++x)
      keyed.emplace_back(spread_bits(std::uint32_t(x)) | (spread_bits(std::uint32_t(y)) << 1), glm::ivec2(x, y));
  std::sort(keyed.begin(), keyed.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [key, place] : keyed) tiling.order.push_back(place);
  return tiling;
}

/// Finds the discs near a point without asking all of them.
class BarePlaces {
 public:
  BarePlaces(const Region& region, const std::vector<Disc>& discs) : low_(region.low) {
    const glm::dvec2 edges = region.high - region.low;
    cell_ = std::max({edges.x / 256, edges.y / 256, 0.5});
    cells_ = glm::ivec2(edges / cell_) + 1;
    discs_.resize(std::size_t(cells_.x) * cells_.y);
    for (const Disc& disc : discs) {
      const glm::dvec2 from = (disc.centre - disc.radius - low_) / cell_,
                       to = (disc.centre + disc.radius - low_) / cell_;
      if (from.x >= cells_.x || from.y >= cells_.y || to.x < 0 || to.y < 0) continue;
      const glm::ivec2 first(glm::max(from, glm::dvec2(0))), last(glm::min(to, glm::dvec2(cells_ - 1)));
      for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) discs_[std::size_t(y) * cells_.x + x].push_back(disc);
    }
  }

  bool contain(glm::dvec2 at) const {
    const glm::ivec2 cell = glm::clamp(glm::ivec2((at - low_) / cell_), glm::ivec2(0), cells_ - 1);
    const auto& near = discs_[std::size_t(cell.y) * cells_.x + cell.x];
    return std::any_of(near.begin(), near.end(), [&](const Disc& disc) {
      const glm::dvec2 apart = at - disc.centre;
      return glm::dot(apart, apart) < disc.radius * disc.radius;
    });
  }

 private:
  glm::dvec2 low_;
  double cell_ = 1;
  glm::ivec2 cells_{1};
  std::vector<std::vector<Disc>> discs_;
};

/// Where a blade that joins a tuft is rooted: around the centre of the tuft on whose ground it would have stood alone.
glm::dvec2 root_in_tuft(glm::dvec2 alone, const GrassField& field, std::uint64_t seed, std::uint64_t stream,
                        Random& random) {
  const double distance = std::sqrt(blades_per_tuft / field.density);
  const glm::dvec2 cell = glm::floor((alone - field.region.low) / distance);
  const auto tuft = std::uint64_t(cell.y) * 0x100000000u + std::uint64_t(cell.x);
  Random place(seed, mix_bits(stream), tuft);
  const double x = place.uniform(), y = place.uniform();
  const double dx = random.normal(), dy = random.normal();
  return field.region.low + distance * (cell + glm::dvec2(x, y) + tuft_radius * glm::dvec2(dx, dy));
}

void resize(GrassBlades& blades, std::size_t count) {
  for (auto* values : {&blades.root_x, &blades.root_y, &blades.root_z, &blades.length, &blades.half_width,
                       &blades.bend_x, &blades.bend_y, &blades.facing, &blades.flexibility, &blades.phase})
    values->resize(count);
}

/// A length or stiffness is positive: at least a tenth of its mean.
double positive(const Spread& spread, Random& random) {
  return std::max(random.normal(spread.mean, spread.deviation), 0.1 * spread.mean);
}

struct Root {
  glm::dvec2 at;
  std::optional<double> height;  // nothing: no blade here
};

void shape_blade(GrassBlades& blades, std::size_t i, const Root& root, const GrassField& field, Random& random) {
  constexpr double turn = 2 * std::numbers::pi;
  blades.root_x[i] = static_cast<float>(root.at.x);
  blades.root_y[i] = static_cast<float>(root.at.y);
  blades.root_z[i] = static_cast<float>(*root.height);
  blades.length[i] = static_cast<float>(positive(field.height, random));
  blades.half_width[i] = static_cast<float>(positive(field.width, random) / 2);
  // A blade bends flat-wise, so it faces across its bend, give or take a twist.
  const double bend = std::clamp(random.normal(field.bend.mean, field.bend.deviation), 0.0, 2.0);
  const double azimuth = random.uniform(0, turn);
  blades.bend_x[i] = static_cast<float>(bend * std::cos(azimuth));
  blades.bend_y[i] = static_cast<float>(bend * std::sin(azimuth));
  blades.facing[i] = static_cast<float>(azimuth + turn / 4 + random.uniform(-0.4, 0.4));
  blades.flexibility[i] = static_cast<float>(1 / positive(field.stiffness, random));
  blades.phase[i] = static_cast<float>(random.uniform(0, turn));
}

/// Moves the blades that stand to the front, in order.
void drop_rootless(GrassBlades& blades, const std::vector<char>& stands) {
  std::size_t kept = 0;
  for (auto* values : {&blades.root_x, &blades.root_y, &blades.root_z, &blades.length, &blades.half_width,
                       &blades.bend_x, &blades.bend_y, &blades.facing, &blades.flexibility, &blades.phase}) {
    kept = 0;
    for (std::size_t i = 0; i < stands.size(); ++i)
      if (stands[i]) (*values)[kept++] = (*values)[i];
  }
  resize(blades, kept);
}

constexpr double most_blades = 1e8;  // 7 vertices each: about what 32-bit ids and 16 GiB of a device can hold

}  // namespace

GrassBlades grow_grass(const GrassField& field, std::uint32_t index, std::uint64_t seed, const GroundHeight& ground,
                       const std::vector<Disc>& bare) {
  const double asked = field.density * field.region.area();
  if (asked > most_blades)
    throw Error(ErrorKind::invalid_input,
                fmt::format("grass.{}: density {} over {} m^2 makes {:.3g} blades (allowed: at most {:.0f})", index,
                            field.density, field.region.area(), asked, most_blades));
  const auto count = static_cast<std::size_t>(std::llround(asked));
  const Tiling tiling = tile(field.region, double(count));
  const BarePlaces bare_places(field.region, bare);
  const std::uint64_t stream = stream_of("grass", index);
  GrassBlades blades;
  blades.field = index;
  resize(blades, count);
  std::vector<char> stands(count, 0);
  const std::size_t tiles = tiling.order.size();
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tiles, 64), [&](const auto& range) {
    for (std::size_t t = range.begin(); t < range.end(); ++t)
      for (std::size_t i = t * count / tiles; i < (t + 1) * count / tiles; ++i) {
        Random random(seed, stream, i);
        const double x = random.uniform(), y = random.uniform();
        Root root{field.region.low + tiling.size() * (glm::dvec2(tiling.order[t]) + glm::dvec2(x, y)), {}};
        if (random.uniform() < field.clumping) {
          const glm::dvec2 in_tuft = root_in_tuft(root.at, field, seed, stream, random);
          if (field.region.contains(in_tuft)) root.at = in_tuft;
        }
        if (!bare_places.contain(root.at)) root.height = ground(root.at);
        stands[i] = root.height.has_value();
        if (stands[i]) shape_blade(blades, i, root, field, random);
      }
  });
  drop_rootless(blades, stands);
  if (count > 0 && blades.size() == 0)
    throw Error(ErrorKind::invalid_input, "grass." + std::to_string(index) + ".region: no blade finds ground there");
  return blades;
}

double exponential_integral_3(double x) {
  if (x <= 0) return 0.5;
  if (x > 100) return 0;  // below 4e-46; libstdc++'s expint is wrong there by orders of magnitude
  // E_1(x) = -Ei(-x); recurrence n E_{n+1} = exp(-x) - x E_n (Abramowitz & Stegun 5.1.14).
  return std::max(0.0, (std::exp(-x) * (1 - x) - x * x * std::expint(-x)) / 2);
}

GroundCover cover_ground(const std::vector<GrassBlades>& fields) {
  glm::dvec2 low(std::numeric_limits<double>::infinity()), high = -low;
  double height_sum = 0, blades = 0;
  for (const GrassBlades& field : fields)
    for (std::size_t i = 0; i < field.size(); ++i) {
      low = glm::min(low, glm::dvec2(field.root_x[i], field.root_y[i]));
      high = glm::max(high, glm::dvec2(field.root_x[i], field.root_y[i]));
      height_sum += field.length[i];
      blades += 1;
    }
  GroundCover cover;
  if (blades == 0) return cover;
  const glm::dvec2 edges = high - low;
  const double cell = std::max({0.25, height_sum / blades, edges.x / 1022, edges.y / 1022});
  const glm::ivec2 inner = glm::ivec2(edges / cell) + 1;
  cover.columns = std::uint32_t(inner.x + 2);
  cover.rows = std::uint32_t(inner.y + 2);
  const glm::dvec2 whole = cell * glm::dvec2(inner + 2);
  cover.extent.low = (low + high) / 2.0 - whole / 2.0;
  cover.extent.high = cover.extent.low + whole;
  std::vector<double> area(std::size_t(cover.columns) * cover.rows, 0);
  for (const GrassBlades& field : fields)
    for (std::size_t i = 0; i < field.size(); ++i) {
      const glm::ivec2 place((glm::dvec2(field.root_x[i], field.root_y[i]) - cover.extent.low) / cell);
      area[std::size_t(place.y) * cover.columns + place.x] +=
          2 * blade_fullness * double(field.length[i]) * double(field.half_width[i]);
    }
  cover.visibility.resize(area.size());
  std::transform(area.begin(), area.end(), cover.visibility.begin(), [&](double leaf_area) {
    return static_cast<float>(2 * exponential_integral_3(leaf_area / (cell * cell) / 2));
  });
  return cover;
}

}  // namespace understory
