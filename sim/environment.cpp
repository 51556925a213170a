// Means over cones row by row of the map: a cone covers one interval of longitudes in each row, whose sum is the
// difference of two running sums. Exact for a map that is constant within its pixels, but for the rows' own height.
#include "sim/environment.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernels/shared/environment.h"

namespace understory {
namespace {

constexpr double pi = std::numbers::pi;
constexpr int most_rows = 512, rows_for_normals = 128, least_bands = 512;
/// What lies below the horizon counts this much, as the mirror image of what lies above.
constexpr double weight_below = 1e-3;

/// Area averages on the sphere; `rows` at most the map's.
EnvironmentMap reduced(const EnvironmentMap& map, int rows) {
  if (map.height <= rows) return map;
  EnvironmentMap small{2 * rows, rows, std::vector<glm::vec3>(2 * std::size_t(rows) * std::size_t(rows))};
  const auto edge = [](int i, int count, int size) { return static_cast<int>(std::int64_t{i} * size / count); };
  tbb::parallel_for(0, small.height, [&](int row) {
    for (int column = 0; column < small.width; ++column) {
      glm::dvec3 sum(0);
      double weights = 0;
      for (int y = edge(row, small.height, map.height); y < edge(row + 1, small.height, map.height); ++y)
        for (int x = edge(column, small.width, map.width); x < edge(column + 1, small.width, map.width); ++x) {
          const double weight = std::sin(pi * (y + 0.5) / map.height);
          sum += weight * glm::dvec3(map.radiance[std::size_t(y) * std::size_t(map.width) + std::size_t(x)]);
          weights += weight;
        }
      small.radiance[std::size_t(row) * std::size_t(small.width) + std::size_t(column)] = glm::vec3(sum / weights);
    }
  });
  return small;
}

/// Row that gives its light to this one, and how much it counts.
struct RowLight {
  int row;
  double weight;
};
RowLight row_light(const EnvironmentMap& map, Sky sky, int row) {
  if (sky == Sky::sphere || 2 * row + 1 <= map.height) return {row, 1};
  return {map.height - 1 - row, weight_below};
}

class ConeMeans {
 public:
  ConeMeans(const EnvironmentMap& map, double turn, Sky sky)
      : map_(map), turn_(turn), bands_(std::max(1, least_bands / map.height)), sums_(row_size() * map.height) {
    for (int row = 0; row < map.height; ++row) {
      const RowLight light = row_light(map, sky, row);
      const glm::vec3* from = map.radiance.data() + std::size_t(light.row) * std::size_t(map.width);
      glm::dvec3* sum = sums_.data() + row_size() * std::size_t(row);
      for (int x = 0; x < map.width; ++x) sum[x + 1] = sum[x] + glm::dvec3(from[x]);
      weights_.push_back(light.weight);
    }
    for (int i = 0; i < map.height * bands_; ++i) {
      const double top = pi * i / (map.height * bands_), below = pi * (i + 1) / (map.height * bands_);
      // The latitude that halves the band's area.
      const double height = (std::cos(top) + std::cos(below)) / 2;
      heights_.push_back({height, std::sqrt((1 - height) * (1 + height)), std::cos(top) - std::cos(below)});
    }
  }

  glm::vec3 mean(glm::dvec3 axis, double half_angle) const {
    const double flat = std::hypot(axis.x, axis.y), cosine = std::cos(half_angle);
    const double middle = map_.width * (0.5 - (std::atan2(axis.y, axis.x) - turn_) / (2 * pi));
    glm::dvec3 light(0);
    double area = 0;
    for (std::size_t i = 0; i < heights_.size(); ++i) {
      const auto [height, ring, band] = heights_[i];
      const double reach = cosine - height * axis.z, most = ring * flat;
      if (reach >= most) continue;  // the row is outside the cone
      const double half = reach <= -most ? 0.5 : std::acos(reach / most) / (2 * pi);
      const std::size_t row = i / static_cast<std::size_t>(bands_);
      const double weight = weights_[row] * band;
      light += weight * (sum_until(row, middle + half * map_.width) - sum_until(row, middle - half * map_.width));
      area += weight * 2 * half * map_.width;
    }
    if (!(area > 0)) return radiance_towards(map_, turn_, axis);
    return glm::vec3(light / area);
  }

 private:
  struct Band {
    double height, ring, area;  // of the unit sphere: z, radius, height of the band
  };

  std::size_t row_size() const { return static_cast<std::size_t>(map_.width) + 1; }

  /// Sum of a row's pixels from column 0 to a fractional one, which may be turns away.
  glm::dvec3 sum_until(std::size_t row, double column) const {
    const double turns = std::floor(column / map_.width), within = column - turns * map_.width;
    const auto whole = std::min(static_cast<std::size_t>(within), row_size() - 2);
    const glm::dvec3* sum = sums_.data() + row_size() * row;
    return turns * sum[map_.width] + glm::mix(sum[whole], sum[whole + 1], within - static_cast<double>(whole));
  }

  const EnvironmentMap& map_;
  double turn_;
  int bands_;  // per row of the map
  std::vector<glm::dvec3> sums_;
  std::vector<double> weights_;
  std::vector<Band> heights_;
};

/// Mean over the sky that a normal faces, weighted by the cosine.
class NormalMeans {
 public:
  NormalMeans(const EnvironmentMap& map, double turn, Sky sky) {
    const int parts = std::max(1, rows_for_normals / (2 * map.height));  // of a pixel, each way
    for (int row = 0; row < map.height * parts; ++row) {
      const RowLight light = row_light(map, sky, row / parts);
      const double polar = pi * (row + 0.5) / (map.height * parts), weight = light.weight * std::sin(polar);
      for (int column = 0; column < map.width * parts; ++column) {
        const double azimuth = turn + 2 * pi * (0.5 - (column + 0.5) / (map.width * parts));
        pixels_.push_back(
            {{std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar)},
             weight,
             map.radiance[std::size_t(light.row) * std::size_t(map.width) + std::size_t(column / parts)]});
      }
    }
  }

  glm::vec3 mean(glm::dvec3 normal) const {
    glm::dvec3 light(0);
    double weights = 0;
    for (const Pixel& pixel : pixels_) {
      const double weight = pixel.weight * std::max(0.0, glm::dot(normal, pixel.direction));
      light += weight * glm::dvec3(pixel.radiance);
      weights += weight;
    }
    return glm::vec3(light / weights);
  }

 private:
  struct Pixel {
    glm::dvec3 direction;
    double weight;
    glm::vec3 radiance;
  };
  std::vector<Pixel> pixels_;
};

/// Fills one square of nodes.
template <class MeanOf>
void fill_square(std::uint32_t nodes, float* out, const MeanOf& mean_of) {
  tbb::parallel_for(0u, nodes * nodes, [&](std::uint32_t node) {
    const OctahedralPlace place{double(node % nodes) / (nodes - 1), double(node / nodes) / (nodes - 1)};
    const OctahedralDirection d = octahedral_direction(place);
    const glm::vec3 mean = mean_of(glm::normalize(glm::dvec3(d.x, d.y, d.z)));
    for (int channel = 0; channel < 3; ++channel) out[4 * std::size_t(node) + std::size_t(channel)] = mean[channel];
  });
}

}  // namespace

glm::vec3 radiance_towards(const EnvironmentMap& map, double turn, glm::dvec3 direction) {
  const double azimuth = std::atan2(direction.y, direction.x) - turn;
  const double polar = std::atan2(std::hypot(direction.x, direction.y), direction.z);
  const double across = map.width * (0.5 - azimuth / (2 * pi)) - 0.5, down = map.height * polar / pi - 0.5;
  const double left = std::floor(across), top = std::floor(down);
  const auto pixel = [&](double column, double row) {
    const auto y = static_cast<std::size_t>(std::clamp(row, 0.0, map.height - 1.0));
    const auto x = static_cast<std::size_t>(column - std::floor(column / map.width) * map.width);
    return map.radiance[y * std::size_t(map.width) + std::min(x, std::size_t(map.width) - 1)];
  };
  const float u = static_cast<float>(across - left), v = static_cast<float>(down - top);
  return glm::mix(glm::mix(pixel(left, top), pixel(left + 1, top), u),
                  glm::mix(pixel(left, top + 1), pixel(left + 1, top + 1), u), v);
}

PrefilteredEnvironment prefilter(const EnvironmentMap& map, double turn, Sky sky, PrefilterSize size) {
  PrefilteredEnvironment result;
  result.size = size;
  const EnvironmentMap coarse = reduced(map, rows_for_normals), fine = reduced(map, most_rows);
  const NormalMeans normals(coarse, turn, sky);
  result.normals.resize(4 * std::size_t(size.normal_nodes) * size.normal_nodes);
  fill_square(size.normal_nodes, result.normals.data(), [&](glm::dvec3 normal) { return normals.mean(normal); });
  result.mean = normals.mean({0, 0, 1});

  const ConeMeans cones(fine, turn, sky);
  const std::size_t square = 4 * std::size_t(size.cone_nodes) * size.cone_nodes;
  const double narrowest = pi / (size.cone_nodes - 1);  // half-angle
  result.cones.resize(square * size.cone_levels);
  for (std::uint32_t level = 0; level < size.cone_levels; ++level) {
    const double sine = double(level) / (size.cone_levels - 1);  // of half the half-angle: its square is the aperture
    const double half_angle = std::max(2 * std::asin(sine), narrowest);
    fill_square(size.cone_nodes, result.cones.data() + square * level,
                [&](glm::dvec3 axis) { return cones.mean(axis, half_angle); });
  }
  return result;
}

}  // namespace understory
