#include "sim/own_shadow.hpp"

#include <algorithm>
#include <cmath>

#include "sim/error.hpp"

namespace understory {
namespace {

/// Where a point is among the samples.
struct Cell {
  std::uint32_t first[3];
  double part[3];
};

Cell cell_of(glm::dvec3 position, glm::dvec3 low, glm::dvec3 high, std::uint32_t size) {
  Cell cell{};
  for (int axis = 0; axis < 3; ++axis) {
    const double last = size - 1, at = (position[axis] - low[axis]) / (high[axis] - low[axis]) * last;
    const double inside = at > 0 ? std::min(at, last) : 0;
    cell.first[axis] = static_cast<std::uint32_t>(std::min(std::floor(inside), last - 1));
    cell.part[axis] = inside - cell.first[axis];
  }
  return cell;
}

/// `visit` gets the index and the weight of each of the eight samples about a point.
template <class Visit>
void for_each_corner(const Cell& cell, std::uint32_t size, const Visit& visit) {
  for (std::uint32_t corner = 0; corner < 8; ++corner) {
    const std::uint32_t side[3] = {corner & 1u, corner >> 1 & 1u, corner >> 2};
    double weight = 1;
    for (int axis = 0; axis < 3; ++axis) weight *= side[axis] ? cell.part[axis] : 1 - cell.part[axis];
    visit((std::size_t(cell.first[2] + side[2]) * size + cell.first[1] + side[1]) * size + cell.first[0] + side[0],
          weight);
  }
}

/// Sums of the normal equations of v and s.
struct Equations {
  glm::dmat4 matrix{0};
  glm::dvec4 right{0};
};

/// v is held back a little, so that a share that does not depend on the normal is all in s.
glm::vec4 solved(const Equations& equations) {
  glm::dmat4 matrix = equations.matrix;
  const double weight = matrix[3][3];
  for (int i = 0; i < 3; ++i) matrix[i][i] += 0.02 * weight;
  const glm::dvec4 fit = glm::inverse(matrix) * equations.right;
  return glm::vec4(glm::clamp(fit, glm::dvec4(-1), glm::dvec4(1)));
}

/// Samples that are not known and have neighbours that are take their mean.
void spread(std::vector<glm::vec4>& fit, std::vector<char>& known, std::uint32_t size) {
  const std::vector<char> before = known;
  const auto last = static_cast<int>(size) - 1;
  for (int z = 0; z <= last; ++z)
    for (int y = 0; y <= last; ++y)
      for (int x = 0; x <= last; ++x) {
        const std::size_t i = (std::size_t(z) * size + y) * size + x;
        if (before[i]) continue;
        glm::vec4 sum(0);
        float count = 0;
        for (int c = std::max(z - 1, 0); c <= std::min(z + 1, last); ++c)
          for (int b = std::max(y - 1, 0); b <= std::min(y + 1, last); ++b)
            for (int a = std::max(x - 1, 0); a <= std::min(x + 1, last); ++a)
              if (const std::size_t j = (std::size_t(c) * size + b) * size + a; before[j]) sum += fit[j], ++count;
        if (count > 0) fit[i] = sum / count, known[i] = 1;
      }
}

}  // namespace

OwnShadow fit_own_shadow(std::span<const OwnShadowPoint> points, glm::vec3 low, glm::vec3 high, std::uint32_t size) {
  OwnShadow shadow;
  if (std::all_of(points.begin(), points.end(), [](const OwnShadowPoint& point) { return point.share == 0; }))
    return shadow;
  shadow.size = size;
  shadow.low = low;
  shadow.high = high;
  const std::size_t samples = std::size_t(size) * size * size;
  std::vector<Equations> equations(samples);
  for (const OwnShadowPoint& point : points) {
    const glm::dvec4 row(glm::dvec3(point.normal), 1);
    for_each_corner(cell_of(glm::dvec3(point.position), glm::dvec3(low), glm::dvec3(high), size), size,
                    [&](std::size_t i, double weight) {
                      equations[i].matrix += glm::outerProduct(weight * row, row);
                      equations[i].right += weight * double(point.share) * row;
                    });
  }
  shadow.fit.assign(samples, glm::vec4(0));
  std::vector<char> known(samples, 0);
  for (std::size_t i = 0; i < samples; ++i)
    if (equations[i].matrix[3][3] > 1e-6) shadow.fit[i] = solved(equations[i]), known[i] = 1;
  spread(shadow.fit, known, size);
  return shadow;
}

float own_share(const OwnShadow& shadow, glm::dvec3 position, glm::dvec3 normal) {
  if (shadow.size == 0) return 0;
  glm::dvec4 fit(0);
  for_each_corner(cell_of(position, glm::dvec3(shadow.low), glm::dvec3(shadow.high), shadow.size), shadow.size,
                  [&](std::size_t i, double weight) { fit += weight * glm::dvec4(shadow.fit[i]); });
  return static_cast<float>(std::clamp(glm::dot(fit, glm::dvec4(normal, 1)), 0.0, 1.0));
}

std::vector<std::uint8_t> packed_own_shadow(const OwnShadow& shadow) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(4 * shadow.fit.size());
  for (const glm::vec4& fit : shadow.fit)
    for (int i = 0; i < 4; ++i)
      bytes.push_back(static_cast<std::uint8_t>(128 + std::lround(std::clamp(fit[i], -1.0f, 1.0f) * 127)));
  return bytes;
}

OwnShadow unpacked(const OwnShadow& shape, std::span<const std::uint8_t> bytes) {
  if (bytes.size() != 4 * shape.fit.size())
    throw Error(ErrorKind::unexpected, "a packed own shadow of " + std::to_string(shape.fit.size()) + " samples has " +
                                           std::to_string(bytes.size()) + " bytes");
  OwnShadow shadow = shape;
  for (std::size_t i = 0; i < shape.fit.size(); ++i)
    for (int k = 0; k < 4; ++k) shadow.fit[i][k] = static_cast<float>(bytes[4 * i + k] - 128) / 127;
  return shadow;
}

}  // namespace understory
