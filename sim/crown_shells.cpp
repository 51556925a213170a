// Several spheres around one crown: its foliage in clusters, each with the smallest sphere that holds it (Hegeman et
// al. 2006, section 5).
#include <algorithm>
#include <limits>

#include "sim/crown.hpp"

namespace understory {
namespace {

std::size_t nearest(const std::vector<glm::dvec3>& centres, const glm::dvec3& point) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < centres.size(); ++i) {
    const glm::dvec3 offset = point - centres[i];
    if (const double square = glm::dot(offset, offset); square < least) least = square, best = i;
  }
  return best;
}

/// The first centre is the mean, each further one the point farthest from all so far: no chance in it (Gonzalez 1985).
std::vector<glm::dvec3> spread_centres(const std::vector<glm::dvec3>& points, std::size_t count) {
  glm::dvec3 mean(0);
  for (const glm::dvec3& point : points) mean += point / static_cast<double>(points.size());
  std::vector<glm::dvec3> centres{mean};
  std::vector<double> distance(points.size(), std::numeric_limits<double>::infinity());
  while (centres.size() < count) {
    std::size_t far = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const glm::dvec3 offset = points[i] - centres.back();
      distance[i] = std::min(distance[i], glm::dot(offset, offset));
      if (distance[i] > distance[far]) far = i;
    }
    if (!(distance[far] > 0)) break;  // fewer places than centres
    centres.push_back(points[far]);
  }
  return centres;
}

}  // namespace

std::vector<Sphere> cluster_spheres(const std::vector<glm::vec3>& all, int count) {
  constexpr std::size_t most_points = 20'000;  // that decide where the clusters are
  constexpr int rounds = 30;
  if (all.empty() || count < 1) return {};
  const std::size_t stride = std::max<std::size_t>(1, all.size() / most_points);
  std::vector<glm::dvec3> points;
  for (std::size_t i = 0; i < all.size(); i += stride) points.emplace_back(all[i]);
  std::vector<glm::dvec3> centres = spread_centres(points, static_cast<std::size_t>(count));
  for (int round = 0; round < rounds; ++round) {  // Lloyd 1982
    std::vector<glm::dvec3> sum(centres.size(), glm::dvec3(0));
    std::vector<double> members(centres.size(), 0);
    for (const glm::dvec3& point : points) {
      const std::size_t cluster = nearest(centres, point);
      sum[cluster] += point;
      members[cluster] += 1;
    }
    for (std::size_t i = 0; i < centres.size(); ++i)
      if (members[i] > 0) centres[i] = sum[i] / members[i];
  }
  std::vector<std::vector<glm::vec3>> clusters(centres.size());
  for (const glm::vec3& point : all) clusters[nearest(centres, glm::dvec3(point))].push_back(point);
  std::vector<Sphere> spheres;
  for (const std::vector<glm::vec3>& cluster : clusters)
    if (const Sphere sphere = smallest_sphere(cluster); sphere.radius > 0) spheres.push_back(sphere);
  return spheres;
}

}  // namespace understory
