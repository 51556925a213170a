// Ridge regression in every cell of a hierarchy of grids, coarse to fine: each cell's function is drawn towards its
// parent's, so that cells with few samples stay sensible.
#include "host/trace/crown_field.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/trace/seen_samples.hpp"

namespace understory {
namespace {

using Coefficients = Eigen::Matrix<double, FIELD_COEFFICIENTS, 1>;
using Square = Eigen::Matrix<double, FIELD_COEFFICIENTS, FIELD_COEFFICIENTS>;

/// A cell's function is drawn to its parent's as if by so many samples of every kind.
constexpr double samples_of_parent = 12;

/// Cells of one level; a cell's children are the 2 x 2 x 2 cells below it on the next.
struct Level {
  glm::ivec3 cells{1};
  std::vector<std::int32_t> row;       // of `sums`; -1: no sample
  std::vector<Square> squares;         // sum of w w^T over the cell's samples, w the terms of the function
  std::vector<Coefficients> products;  // sum of w V
  std::vector<Coefficients> fitted;    // per cell

  std::size_t size() const { return row.size(); }
  std::size_t number(glm::ivec3 at) const {
    return (static_cast<std::size_t>(at.z) * static_cast<std::size_t>(cells.y) + static_cast<std::size_t>(at.y)) *
               static_cast<std::size_t>(cells.x) +
           static_cast<std::size_t>(at.x);
  }
  glm::ivec3 place(std::size_t number) const {
    const int n = static_cast<int>(number);
    return {n % cells.x, n / cells.x % cells.y, n / cells.x / cells.y};
  }
};

Level empty_level(glm::ivec3 cells) {
  Level level;
  level.cells = cells;
  level.row.assign(static_cast<std::size_t>(cells.x * cells.y * cells.z), -1);
  return level;
}

/// The terms of the function: FIELD_VALUE with one coefficient 1, the others 0.
Coefficients terms(glm::dvec3 n, glm::dvec3 q) {
  Coefficients w;
  for (int term = 0; term < FIELD_COEFFICIENTS; ++term) {
    const auto only = [&](int number) { return number == term ? 1.0 : 0.0; };
    w[term] = FIELD_VALUE(only, n.x, n.y, n.z, q.x, q.y, q.z);
  }
  return w;
}

/// Where a child's middle lies in its parent, in half-edges of the parent.
glm::dvec3 middle_in_parent(glm::ivec3 child) {
  const auto side = [](int index) { return index % 2 == 0 ? -0.5 : 0.5; };
  return {side(child.x), side(child.y), side(child.z)};
}

/// The parent's terms as combinations of a child's: q_parent = middle + q_child / 2. Also takes the parent's function
/// to the child: c_child = M^T c_parent.
Square parent_terms(glm::ivec3 child) {
  Square m = Square::Identity();
  const glm::dvec3 middle = middle_in_parent(child);
  for (int axis = 0; axis < 3; ++axis) {
    m(9 + axis, 9 + axis) = 0.5;
    m(9 + axis, 0) = middle[axis];
  }
  return m;
}

/// The finest level, with the sums of its samples.
Level gather(const CrownFieldGrid& grid, const std::vector<SeenSample>& samples) {
  Level level =
      empty_level({static_cast<int>(grid.columns), static_cast<int>(grid.rows), static_cast<int>(grid.layers)});
  const glm::vec3 low(grid.low_x, grid.low_y, grid.low_z);
  const auto cell_of = [&](const SeenSample& sample) {
    const glm::vec3 place = (sample.point.position - low) * grid.cells_per_metre;
    return glm::clamp(glm::ivec3(glm::floor(place)), glm::ivec3(0), level.cells - 1);
  };
  std::vector<std::uint32_t> cell(samples.size()), order(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i)
    cell[i] = static_cast<std::uint32_t>(level.number(cell_of(samples[i])));
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return cell[a] < cell[b]; });
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < order.size(); ++i)
    if (i == 0 || cell[order[i]] != cell[order[i - 1]]) {
      level.row[cell[order[i]]] = static_cast<std::int32_t>(starts.size());
      starts.push_back(i);
    }
  level.squares.assign(starts.size(), Square::Zero());
  level.products.assign(starts.size(), Coefficients::Zero());
  starts.push_back(order.size());
  tbb::parallel_for(std::size_t(0), level.squares.size(), [&](std::size_t row) {
    const glm::vec3 at(level.place(cell[order[starts[row]]]));
    for (std::size_t i = starts[row]; i < starts[row + 1]; ++i) {
      const SeenSample& sample = samples[order[i]];
      const glm::vec3 q = 2.0f * ((sample.point.position - low) * grid.cells_per_metre - at) - 1.0f;
      const Coefficients w = terms(glm::dvec3(sample.point.normal), glm::dvec3(glm::clamp(q, -1.0f, 1.0f)));
      level.squares[row] += w * w.transpose();
      level.products[row] += double(sample.visibility) * w;
    }
  });
  return level;
}

/// The level above: the same samples in cells twice as large.
Level coarser(const Level& fine) {
  Level level = empty_level((fine.cells + 1) / 2);
  for (std::size_t i = 0; i < fine.size(); ++i) {
    if (fine.row[i] < 0) continue;
    const glm::ivec3 at = fine.place(i);
    std::int32_t& row = level.row[level.number(at / 2)];
    if (row < 0) {
      row = static_cast<std::int32_t>(level.squares.size());
      level.squares.push_back(Square::Zero());
      level.products.push_back(Coefficients::Zero());
    }
    const Square m = parent_terms(at);
    const auto from = static_cast<std::size_t>(fine.row[i]), to = static_cast<std::size_t>(row);
    level.squares[to] += m * fine.squares[from] * m.transpose();
    level.products[to] += m * fine.products[from];
  }
  return level;
}

void fit(Level& level, const Level* parent) {
  level.fitted.resize(level.size());
  tbb::parallel_for(std::size_t(0), level.size(), [&](std::size_t i) {
    Coefficients expected = Coefficients::Zero();
    expected[0] = 0.5;
    if (parent) {
      const glm::ivec3 at = level.place(i);
      expected = parent_terms(at).transpose() * parent->fitted[parent->number(at / 2)];
    }
    level.fitted[i] = expected;
    if (level.row[i] < 0) return;
    const auto row = static_cast<std::size_t>(level.row[i]);
    const double weight = parent ? samples_of_parent : 1e-3;
    const Square sum = level.squares[row] + weight * Square::Identity();
    level.fitted[i] = sum.llt().solve(level.products[row] + weight * expected);
  });
}

CrownFieldGrid grid_around(const Prototype& prototype, int cells) {
  const glm::vec3 extent = prototype.high - prototype.low;
  const float longest = std::max({extent.x, extent.y, extent.z, 1e-6f});
  CrownFieldGrid grid{};
  grid.low_x = prototype.low.x;
  grid.low_y = prototype.low.y;
  grid.low_z = prototype.low.z;
  grid.cells_per_metre = static_cast<float>(cells) / longest;
  const auto count = [&](float edge) {
    return static_cast<record_uint>(std::clamp(static_cast<int>(std::ceil(edge * grid.cells_per_metre)), 1, cells));
  };
  grid.columns = count(extent.x);
  grid.rows = count(extent.y);
  grid.layers = count(extent.z);
  return grid;
}

void store(const Level& level, std::vector<std::uint32_t>& words) {
  words.assign(level.size() * FIELD_WORDS, 0);
  for (std::size_t i = 0; i < level.size(); ++i)
    for (int k = 0; k < FIELD_COEFFICIENTS; ++k) {
      const double steps = std::clamp(std::round(level.fitted[i][k] / double(FIELD_STEP)), -127.0, 127.0);
      const auto byte = static_cast<std::uint8_t>(static_cast<std::int8_t>(steps));
      words[i * FIELD_WORDS + static_cast<std::size_t>(k) / 4] |= std::uint32_t{byte} << (8 * (k % 4));
    }
}

}  // namespace

double field_visibility(const CrownField& field, glm::vec3 position, glm::vec3 normal) {
  const CrownFieldGrid& grid = field.grid;
  const glm::vec3 place = (position - glm::vec3(grid.low_x, grid.low_y, grid.low_z)) * grid.cells_per_metre;
  const glm::ivec3 last(grid.columns - 1, grid.rows - 1, grid.layers - 1);
  const glm::ivec3 at = glm::clamp(glm::ivec3(glm::floor(place)), glm::ivec3(0), last);
  const glm::vec3 q = glm::clamp(2.0f * (place - glm::vec3(at)) - 1.0f, -1.0f, 1.0f);
  const std::size_t first =
      FIELD_WORDS * ((static_cast<std::size_t>(at.z) * grid.rows + static_cast<std::size_t>(at.y)) * grid.columns +
                     static_cast<std::size_t>(at.x));
  const auto coefficient = [&](std::size_t number) {
    return double(static_cast<std::int8_t>(field.cells[first + number / 4] >> (8 * (number % 4))));
  };
  const glm::dvec3 n(normal), w(q);
  return std::clamp(double(FIELD_STEP) * FIELD_VALUE(coefficient, n.x, n.y, n.z, w.x, w.y, w.z), 0.0, 1.0);
}

CrownField bake_crown_field(const Prototype& prototype, const CrownFieldOptions& options) {
  CrownField field;
  field.grid = grid_around(prototype, options.cells);
  const RestSurface surface(prototype);
  const auto rays = static_cast<std::size_t>(
      std::clamp(options.rays_per_triangle * double(surface.triangle_count()), options.least_rays, options.most_rays));
  const std::vector<SeenSample> samples = seen_samples(surface, options.sky, rays, options.seed);
  std::vector<Level> levels{gather(field.grid, samples)};
  while (levels.back().size() > 1) levels.push_back(coarser(levels.back()));
  for (std::size_t i = levels.size(); i-- > 0;) fit(levels[i], i + 1 < levels.size() ? &levels[i + 1] : nullptr);
  store(levels.front(), field.cells);
  return field;
}

}  // namespace understory
