#include "sim/grass_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "kernels/shared/grass_bend.h"
#include "kernels/shared/pose_blade.h"
#include "sim/dynamics.hpp"
#include "sim/grass.hpp"
#include "sim/plants/pieces.hpp"
#include "sim/wind.hpp"

namespace understory {
namespace {

constexpr int points_per_blade = 8;

using Visit = std::function<void(const GrassPiece&)>;

/// Half-width at `share` of a blade's length, in units of its base half-width.
double blade_width(double share) {
  for (int pair = 0; pair < 2; ++pair)
    if (share < blade_pair_place[pair + 1]) {
      const double f = (share - blade_pair_place[pair]) / (blade_pair_place[pair + 1] - blade_pair_place[pair]);
      return std::lerp(blade_pair_width[pair], blade_pair_width[pair + 1], f);
    }
  return blade_pair_width[2] * (1 - share) / (1 - blade_pair_place[2]);
}

void visit_blades(const GrassBlades& field, const GrassWind& steady, std::uint32_t first_blade, const Visit& visit) {
  double width[points_per_blade];
  for (int k = 0; k < points_per_blade; ++k) width[k] = blade_width((k + 0.5) / points_per_blade);
  for (std::size_t i = 0; i < field.size(); ++i) {
    const GrassBend bend = grass_bend(steady, 0, 0, double(field.bend_x[i]), double(field.bend_y[i]),
                                      double(field.flexibility[i]), double(field.phase[i]));
    const double angle = std::hypot(bend.x, bend.y), length = double(field.length[i]);
    const glm::dvec2 towards = angle > 0 ? glm::dvec2(bend.x, bend.y) / angle : glm::dvec2(1, 0);
    const glm::dvec3 across(std::cos(double(field.facing[i])), std::sin(double(field.facing[i])), 0);
    const glm::dvec3 root(double(field.root_x[i]), double(field.root_y[i]), double(field.root_z[i]));
    for (int k = 0; k < points_per_blade; ++k) {
      const double share = (k + 0.5) / points_per_blade;
      const BladePoint middle = blade_midline(length, bend.x, bend.y, share);
      const glm::dvec3 along(towards * std::sin(angle * share), std::cos(angle * share));
      const glm::dvec3 normal = glm::cross(across, along);
      const double sine = glm::length(normal);  // the strip is not cut at right angles
      if (sine <= 0) continue;
      visit({root + glm::dvec3(middle.x, middle.y, middle.z),
             2 * double(field.half_width[i]) * width[k] * length / points_per_blade * sine, normal.z / sine,
             first_blade + static_cast<std::uint32_t>(i)});
    }
  }
}

bool has_blades(const Prototype& prototype) {
  return std::any_of(prototype.runs.begin(), prototype.runs.end(),
                     [](const TriangleRun& run) { return run.surface == SurfaceClass::blade; });
}

struct PlantTriangle {
  std::uint32_t first;  // of its corners
  SurfaceClass surface;
  std::uint32_t blade;  // the same for all that hang together, rising
};

/// A plant's triangles, blade by blade.
std::vector<PlantTriangle> triangles_by_blade(const Prototype& prototype) {
  std::vector<glm::vec3> positions;
  for (std::size_t v = 0; v < prototype.vertices.x.size(); ++v)
    positions.emplace_back(prototype.vertices.x[v], prototype.vertices.y[v], prototype.vertices.z[v]);
  const Pieces pieces =
      connected_pieces(positions, prototype.triangles, same_corner * (prototype.high.z - prototype.low.z));
  std::vector<PlantTriangle> all;
  for (const TriangleRun& run : prototype.runs)
    for (std::uint32_t i = 3 * run.first; i < 3 * (run.first + run.count); i += 3)
      all.push_back({i, run.surface, pieces.of_vertex[prototype.triangles[i]]});
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.blade < b.blade; });
  return all;
}

/// Cuts a triangle into about equal pieces no wider than `widest`.
void visit_triangle(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, double weight, std::uint32_t blade, double widest,
                    const Visit& visit) {
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double twice = glm::length(normal);
  if (!(twice > 0)) return;
  const double edge = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
  const int parts = std::clamp(static_cast<int>(std::ceil(edge / widest)), 1, 64);
  const double area = weight * twice / 2 / (parts * parts);
  for (int i = 0; i < parts; ++i)
    for (int j = 0; i + j < parts; ++j)
      for (int turned = 0; turned < (i + j + 1 < parts ? 2 : 1); ++turned) {
        const double u = (i + (1 + turned) / 3.0) / parts, v = (j + (1 + turned) / 3.0) / parts;
        visit({a + u * (b - a) + v * (c - a), area, normal.z / twice, blade});
      }
}

void visit_plant(const Prototype& prototype, const std::vector<PlantTriangle>& triangles, const Instance& instance,
                 std::uint32_t first_blade, double widest, const Visit& visit) {
  const double cosine = std::cos(instance.yaw), sine = std::sin(instance.yaw);
  const auto corner = [&](std::uint32_t index) {
    const std::uint32_t v = prototype.triangles[index];
    const glm::dvec3 p(prototype.vertices.x[v], prototype.vertices.y[v], prototype.vertices.z[v]);
    return instance.position + instance.scale * glm::dvec3(cosine * p.x - sine * p.y, sine * p.x + cosine * p.y, p.z);
  };
  for (const PlantTriangle& triangle : triangles) {
    // Stems are closed: half their surface counts (FORMULAS.md, plant area).
    const double weight = triangle.surface == SurfaceClass::wood ? 0.5 : 1;
    const std::uint32_t i = triangle.first;
    visit_triangle(corner(i), corner(i + 1), corner(i + 2), weight, first_blade + triangle.blade, widest, visit);
  }
}

}  // namespace

void visit_grass(const World& world, double widest, const Visit& visit) {
  std::uint32_t blades = 0;  // that were visited
  for (std::size_t f = 0; f < world.grass.size(); ++f) {
    GrassWind steady{};
    steady.direction_x = static_cast<float>(world.wind->direction().x);
    steady.direction_y = static_cast<float>(world.wind->direction().y);
    steady.mean_bend = static_cast<float>(world.dynamics->grass[f].mean);
    visit_blades(world.grass[f], steady, blades, visit);
    blades += static_cast<std::uint32_t>(world.grass[f].size());
  }
  std::map<std::size_t, std::vector<PlantTriangle>> triangles;
  for (const Instance& instance : world.instances) {
    const Prototype& prototype = world.prototypes[instance.prototype];
    if (instance.role != Instance::Role::plant || !has_blades(prototype)) continue;
    const auto [entry, is_new] = triangles.try_emplace(instance.prototype);
    if (is_new) entry->second = triangles_by_blade(prototype);
    visit_plant(prototype, entry->second, instance, blades, widest, visit);
    if (!entry->second.empty()) blades += entry->second.back().blade + 1;
  }
}

}  // namespace understory
