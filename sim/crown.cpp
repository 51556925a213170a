#include "sim/crown.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace understory {
namespace {

constexpr double pi = std::numbers::pi;

glm::vec3 vertex(const Prototype& prototype, std::uint32_t index) {
  const VertexBlocks& blocks = prototype.vertices;
  return {blocks.x[index], blocks.y[index], blocks.z[index]};
}

bool is_foliage(SurfaceClass surface) { return surface == SurfaceClass::leaf || surface == SurfaceClass::blade; }

/// Calls visit(a, b, c, surface) for the corners of every triangle.
template <typename Visit>
void for_each_triangle(const Prototype& prototype, Visit visit) {
  for (const TriangleRun& run : prototype.runs) {
    for (std::uint32_t i = 3 * run.first; i < 3 * (run.first + run.count); i += 3) {
      const auto corner = [&](std::uint32_t k) { return glm::dvec3(vertex(prototype, prototype.triangles[i + k])); };
      visit(corner(0), corner(1), corner(2), run.surface);
    }
  }
}

bool has_foliage(const Prototype& prototype) {
  return std::any_of(prototype.runs.begin(), prototype.runs.end(),
                     [](const TriangleRun& run) { return is_foliage(run.surface); });
}

/// A piece of the crown's surface: middle and unit normal of a triangle.
struct Sample {
  glm::dvec3 position, normal;
};

/// About `count` triangles of the foliage (wood when leafless), evenly by number: leaves of one plant are alike.
std::vector<Sample> sample_foliage(const Prototype& prototype, std::size_t count) {
  const bool leafy = has_foliage(prototype);
  std::size_t all = 0, seen = 0;
  for (const TriangleRun& run : prototype.runs) all += !leafy || is_foliage(run.surface) ? run.count : 0;
  const std::size_t stride = std::max<std::size_t>(1, all / count);
  std::vector<Sample> samples;
  for_each_triangle(prototype, [&](glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, SurfaceClass surface) {
    if ((leafy && !is_foliage(surface)) || seen++ % stride != 0) return;
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double length = glm::length(normal);
    if (length > 0) samples.push_back({(a + b + c) / 3.0, normal / length});
  });
  return samples;
}

/// A shell in the frame where it is the unit sphere.
struct UnitFrame {
  glm::dvec3 centre, radii;
  glm::dmat3 axes;  // columns
  glm::dvec3 point(const glm::dvec3& p) const { return glm::transpose(axes) * (p - centre) / radii; }
  glm::dvec3 vector(const glm::dvec3& v) const { return glm::transpose(axes) * v / radii; }
  glm::dvec3 normal(const glm::dvec3& n) const { return glm::normalize(glm::transpose(axes) * n * radii); }
  double volume_scale() const { return radii.x * radii.y * radii.z; }
};

UnitFrame sphere_frame(const CrownShell& crown) {
  return {glm::dvec3(crown.sphere_centre), glm::dvec3(crown.sphere_radius), glm::dmat3(1)};
}

UnitFrame ellipsoid_frame(const CrownShell& crown) {
  return {glm::dvec3(crown.ellipsoid_centre), glm::dvec3(crown.ellipsoid_radii), glm::dmat3(crown.ellipsoid_axes)};
}

/// Cosine-weighted mean of exp(-k L) over the hemisphere of the sample's normal, L the way to the shell's exit:
/// FORMULAS.md, crown-transmittance, under `sky: sphere`. 64 directions on a Fibonacci disc lifted to the hemisphere.
double beer_lambert_visibility(const Sample& sample, const UnitFrame& frame, double k) {
  constexpr int directions = 64;
  const glm::dvec3 helper = std::abs(sample.normal.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 side = glm::normalize(glm::cross(helper, sample.normal)), other = glm::cross(sample.normal, side);
  const glm::dvec3 start = frame.point(sample.position);
  double sum = 0;
  for (int i = 0; i < directions; ++i) {
    const double squared = (i + 0.5) / directions, turn = 2.399963229728653 * i;
    const double radius = std::sqrt(squared), height = std::sqrt(1 - squared);
    const glm::dvec3 direction = radius * (std::cos(turn) * side + std::sin(turn) * other) + height * sample.normal;
    const glm::dvec3 step = frame.vector(direction);
    const double a = glm::dot(step, step), b = glm::dot(start, step), c = glm::dot(start, start) - 1;
    sum += std::exp(-k * std::max(0.0, (-b + std::sqrt(std::max(0.0, b * b - a * c))) / a));
  }
  return sum / directions;
}

/// f V_cap of eq. 4 and 5 in the unit sphere, as FORMULAS.md writes it.
double weighted_cap(const glm::dvec3& point, const glm::dvec3& normal) {
  const double above = glm::dot(point, normal), h = std::clamp(1 - above, 0.0, 2.0);
  const double d2 = std::max(glm::dot(point, point) - above * above, 0.0);
  return pi * h * h * h * h * (3 - h) / (3 * std::max(h * h + d2, 1e-12));
}

/// The rate x in [0, 1e9] at which the mean of exp(-x weight) over the weights comes closest to `mean`.
double rate_for_mean(const std::vector<double>& weights, double mean) {
  const auto mean_at = [&](double rate) {
    double sum = 0;
    for (double weight : weights) sum += std::exp(-rate * weight);
    return sum / static_cast<double>(weights.size());
  };
  double low = 0, high = 1e-6;
  while (mean_at(high) > mean && high < 1e9) high *= 2;
  if (mean >= 1) return 0;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (mean_at(middle) > mean ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// `frame_of(position)`: the shell that owns it.
template <typename FrameOf>
std::vector<double> cap_weights(const std::vector<Sample>& samples, const FrameOf& frame_of) {
  std::vector<double> weights;
  for (const Sample& sample : samples) {
    const UnitFrame frame = frame_of(sample.position);
    for (double side : {1.0, -1.0}) {
      const glm::dvec3 normal = frame.normal(side * sample.normal);
      weights.push_back(frame.volume_scale() * weighted_cap(frame.point(sample.position), normal));
    }
  }
  return weights;
}

}  // namespace

double disc_transmittance(double optical_radius) {
  const double a = 2 * optical_radius;  // along the diameter
  // With u = half chord / R, the mean over the disc is the integral of 2 u exp(-a u) over [0, 1].
  if (a < 1e-3) return 1 - 2 * a / 3 + a * a / 4;
  return 2 * (1 - (1 + a) * std::exp(-a)) / (a * a);
}

std::size_t nearest_shell_of(const CrownShell& crown, const glm::dvec3& position) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < crown.shells.size(); ++i)
    if (glm::distance(position, glm::dvec3(crown.shells[i])) < glm::distance(position, glm::dvec3(crown.shells[best])))
      best = i;
  return best;
}

CrownShell fit_crown(const Prototype& prototype, int shells) {
  CrownShell crown;
  const auto has = [&](SurfaceClass surface) {
    return std::any_of(prototype.runs.begin(), prototype.runs.end(),
                       [=](const TriangleRun& run) { return run.surface == surface; });
  };
  if (has(SurfaceClass::blade) && !has(SurfaceClass::leaf)) return crown;  // grass: sim/grass_layer.hpp
  std::vector<glm::vec3> points;
  const bool leafy = has_foliage(prototype);
  double leaf_area = 0, wood_area = 0;
  for_each_triangle(prototype, [&](glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, SurfaceClass surface) {
    const double area = 0.5 * glm::length(glm::cross(b - a, c - a));
    (is_foliage(surface) ? leaf_area : wood_area) += area;
  });
  std::vector<bool> seen(prototype.vertices.x.size(), false);
  for (const TriangleRun& run : prototype.runs) {
    if (leafy && !is_foliage(run.surface)) continue;
    for (std::uint32_t i = 3 * run.first; i < 3 * (run.first + run.count); ++i) {
      const std::uint32_t index = prototype.triangles[i];
      if (!seen[index]) points.push_back(vertex(prototype, index));
      seen[index] = true;
    }
  }
  if (points.empty()) return crown;
  const Sphere sphere = smallest_sphere(points);
  const Ellipsoid ellipsoid = smallest_ellipsoid(points);
  crown.sphere_centre = glm::vec3(sphere.centre);
  crown.sphere_radius = static_cast<float>(sphere.radius);
  crown.ellipsoid_centre = glm::vec3(ellipsoid.centre);
  crown.ellipsoid_axes = glm::mat3(ellipsoid.axes);
  crown.ellipsoid_radii = glm::vec3(ellipsoid.radii);
  for (const Sphere& shell : cluster_spheres(points, shells))
    crown.shells.emplace_back(glm::vec3(shell.centre), static_cast<float>(shell.radius));
  crown.leaf_area = static_cast<float>(leaf_area);
  crown.plant_area = static_cast<float>(leaf_area + 0.5 * wood_area);
  const Limb& trunk = prototype.limbs.front();
  crown.trunk_height = glm::clamp(glm::dot(crown.sphere_centre - trunk.base, trunk.axis), 0.0f, trunk.length);
  return crown;
}

// Eq. 6 leaves alpha rho to the user, and Reeves and Blau their extinction. Both start here from the ensemble mean that
// they stand for: a crown of the ellipsoid's shape filled evenly with the plant's area, k = G PAD, G = 1/2 for
// spherical leaf angles, no clumping, in which a leaf sees the cosine-weighted mean of exp(-k L) (FORMULAS.md). The
// constants are those for which the model's mean over both sides of the foliage, where it really stands, equals that
// crown's mean: right on average for every plant, whatever the leaf angles. The opacity belongs to the sphere with its
// own k, for it is the sphere that shades others.
CrownConstants derive_constants(const Prototype& prototype, double reeves_blau_ambient) {
  constexpr std::size_t sample_count = 1500;
  constexpr double leaf_angle_factor = 0.5;
  CrownConstants constants;
  const CrownShell& crown = prototype.crown;
  const std::vector<Sample> samples = sample_foliage(prototype, sample_count);
  if (crown.sphere_radius <= 0 || samples.empty()) return constants;

  const UnitFrame ellipsoid = ellipsoid_frame(crown), sphere = sphere_frame(crown);
  const double extinction = leaf_angle_factor * crown.plant_area / (4 * pi / 3);  // of a shell with volume scale 1
  const double k = extinction / ellipsoid.volume_scale();
  const auto of = [](const UnitFrame& frame) { return [&frame](const glm::dvec3&) { return frame; }; };
  double sum = 0;
  std::vector<double> depths;
  for (const Sample& sample : samples) {
    sum += beer_lambert_visibility(sample, ellipsoid, k);
    sum += beer_lambert_visibility({sample.position, -sample.normal}, ellipsoid, k);
    depths.push_back(std::max(0.0, crown.sphere_radius - glm::distance(sample.position, sphere.centre)));
  }
  constants.mean_visibility = sum / (2 * static_cast<double>(samples.size()));
  constants.alpha_rho = rate_for_mean(cap_weights(samples, of(sphere)), constants.mean_visibility);
  constants.alpha_rho_ellipsoid = rate_for_mean(cap_weights(samples, of(ellipsoid)), constants.mean_visibility);
  const auto nearest_shell = [&](const glm::dvec3& position) {
    const glm::vec4 shell = crown.shells[nearest_shell_of(crown, position)];
    return UnitFrame{glm::dvec3(shell), glm::dvec3(shell.w), glm::dmat3(1)};
  };
  if (!crown.shells.empty())
    constants.alpha_rho_shells = rate_for_mean(cap_weights(samples, nearest_shell), constants.mean_visibility);
  constants.extinction = k;
  constants.reeves_blau_extinction = rate_for_mean(depths, constants.mean_visibility / reeves_blau_ambient);
  constants.opacity = 1 - disc_transmittance(crown.sphere_radius * extinction / sphere.volume_scale());
  return constants;
}

}  // namespace understory
