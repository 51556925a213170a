#include "bench/canopy_truth.hpp"

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "host/trace/directions.hpp"
#include "host/trace/truth.hpp"
#include "sim/random.hpp"

namespace understory {
namespace {

constexpr double half_width = 7;   // m
constexpr float leaf_edge = 0.1f;  // m
constexpr int side_points = 8;     // points along a side of the middle square of 2 m

Tracer canopy(double leaf_area_index, std::uint64_t realisation) {
  const double area = 4 * half_width * half_width;
  const auto leaves = static_cast<std::uint64_t>(leaf_area_index * area / (leaf_edge * leaf_edge));
  std::vector<glm::vec3> vertices;
  std::vector<std::uint32_t> triangles;
  for (std::uint64_t leaf = 0; leaf < leaves; ++leaf) {
    Random random(realisation, stream_of("canopy"), leaf);
    const auto draw = [&](double low, double high) { return static_cast<float>(random.uniform(low, high)); };
    const glm::vec3 centre(draw(-half_width, half_width), draw(-half_width, half_width), draw(0.1, 1.1));
    const glm::mat3 frame = frame_about(uniform_sphere({draw(0, 1), draw(0, 1)}));
    const glm::vec3 u = 0.5f * leaf_edge * frame[0], v = 0.5f * leaf_edge * frame[1];
    const auto next = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), {centre - u - v, centre + u - v, centre + u + v, centre - u + v});
    triangles.insert(triangles.end(), {next, next + 1, next + 2, next, next + 2, next + 3});
  }
  return Tracer(vertices, triangles);
}

/// E3 by the recurrence n E(n+1)(x) = exp(-x) - x E(n)(x), x > 0.
double exponential_integral_3(double x) {
  const double e1 = -std::expint(-x), e2 = std::exp(-x) - x * e1;
  return (std::exp(-x) - x * e2) / 2;
}

}  // namespace

CanopyTruth trace_canopy(double leaf_area_index, int realisations, int rays) {
  std::vector<glm::vec3> positions;
  for (int i = 0; i < side_points * side_points; ++i)
    positions.emplace_back(0.25 * (i % side_points - 3.5), 0.25 * (i / side_points - 3.5), 0);
  const std::vector<glm::vec3> normals(positions.size(), glm::vec3(0, 0, 1));
  std::vector<double> means;
  for (int r = 0; r < realisations; ++r) {
    const Tracer tracer = canopy(leaf_area_index, static_cast<std::uint64_t>(r));
    const Truth truth = trace_truth(tracer, positions, normals, {.rays = rays});
    double sum = 0;
    for (const float v : truth.visibility) sum += v;
    means.push_back(sum / static_cast<double>(positions.size()));
  }
  CanopyTruth result;
  result.leaf_area_index = leaf_area_index;
  result.closed_form = 2 * exponential_integral_3(leaf_area_index / 2);
  double squares = 0;
  for (const double m : means) result.traced += m / realisations;
  for (const double m : means) squares += (m - result.traced) * (m - result.traced);
  result.standard_error = std::sqrt(squares / (double(realisations) * (realisations - 1)));
  return result;
}

}  // namespace understory
