#include "sim/grass_area.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "kernels/shared/grass_bend.h"
#include "kernels/shared/pose_blade.h"
#include "sim/dynamics.hpp"
#include "sim/grass.hpp"
#include "sim/wind.hpp"
#include "sim/world_builder.hpp"

namespace understory {
namespace {

constexpr double cells_per_height = 16, most_columns = 65536;
constexpr double smallest_cell = 0.03;  // m: smaller ones would hold a single blade, which does not shade itself
constexpr double border = 2;            // in heights of the grass: further away it hides less than 3 % of the sky
constexpr std::uint32_t slab_count = 12;
constexpr int points_per_blade = 8;

/// A piece of a blade or mesh, small beside a cell.
struct Piece {
  glm::dvec3 position;   // relative to the origin, m
  double area;           // one-sided, m^2
  double normal_cosine;  // to the vertical
};
using Visit = std::function<void(const Piece&)>;

/// Half-width at `share` of a blade's length, in units of its base half-width.
double blade_width(double share) {
  for (int pair = 0; pair < 2; ++pair)
    if (share < blade_pair_place[pair + 1]) {
      const double f = (share - blade_pair_place[pair]) / (blade_pair_place[pair + 1] - blade_pair_place[pair]);
      return std::lerp(blade_pair_width[pair], blade_pair_width[pair + 1], f);
    }
  return blade_pair_width[2] * (1 - share) / (1 - blade_pair_place[2]);
}

void visit_blades(const GrassBlades& field, const GrassWind& steady, const Visit& visit) {
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
             2 * double(field.half_width[i]) * width[k] * length / points_per_blade * sine, normal.z / sine});
    }
  }
}

bool has_blades(const Prototype& prototype) {
  return std::any_of(prototype.runs.begin(), prototype.runs.end(),
                     [](const TriangleRun& run) { return run.surface == SurfaceClass::blade; });
}

/// Cuts a triangle into about equal pieces no wider than `widest`.
void visit_triangle(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, double weight, double widest, const Visit& visit) {
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
        visit({a + u * (b - a) + v * (c - a), area, normal.z / twice});
      }
}

void visit_plant(const Prototype& prototype, const Instance& instance, double widest, const Visit& visit) {
  const double cosine = std::cos(instance.yaw), sine = std::sin(instance.yaw);
  const auto corner = [&](std::uint32_t index) {
    const std::uint32_t v = prototype.triangles[index];
    const glm::dvec3 p(prototype.vertices.x[v], prototype.vertices.y[v], prototype.vertices.z[v]);
    return instance.position + instance.scale * glm::dvec3(cosine * p.x - sine * p.y, sine * p.x + cosine * p.y, p.z);
  };
  for (const TriangleRun& run : prototype.runs) {
    // Stems are closed: half their surface counts (FORMULAS.md, plant area).
    const double weight = run.surface == SurfaceClass::wood ? 0.5 : 1;
    for (std::uint32_t i = 3 * run.first; i < 3 * (run.first + run.count); i += 3)
      visit_triangle(corner(i), corner(i + 1), corner(i + 2), weight, widest, visit);
  }
}

/// Every piece of grass in the scene, always in the same order.
void visit_all(const World& world, double widest, const Visit& visit) {
  for (std::size_t f = 0; f < world.grass.size(); ++f) {
    GrassWind steady{};
    steady.direction_x = static_cast<float>(world.wind->direction().x);
    steady.direction_y = static_cast<float>(world.wind->direction().y);
    steady.mean_bend = static_cast<float>(world.dynamics->grass[f].mean);
    visit_blades(world.grass[f], steady, visit);
  }
  for (const Instance& instance : world.instances)
    if (const Prototype& prototype = world.prototypes[instance.prototype];
        instance.role == Instance::Role::plant && has_blades(prototype))
      visit_plant(prototype, instance, widest, visit);
}

/// What bounds the grass, and how high it stands above the ground.
struct Bounds {
  glm::dvec2 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
  double height = 0;
};

Bounds bounds_of(const World& world, const GroundHeight& ground) {
  Bounds bounds;
  visit_all(world, std::numeric_limits<double>::infinity(), [&](const Piece& piece) {
    bounds.low = glm::min(bounds.low, glm::dvec2(piece.position));
    bounds.high = glm::max(bounds.high, glm::dvec2(piece.position));
    bounds.height =
        std::max(bounds.height, piece.position.z - ground(glm::dvec2(piece.position)).value_or(piece.position.z));
  });
  return bounds;
}

/// Heights at the middles of the columns; beside the terrain that of its nearest column in the row, else of the datum.
void level_ground(GrassArea& area, const GroundHeight& ground) {
  area.ground.assign(area.column_count(), 0);
  std::vector<std::optional<double>> heights(area.column_count());
  area.datum = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const glm::dvec2 place(double(i % area.columns) + 0.5, double(i / area.columns) + 0.5);
    heights[i] = ground(area.extent.low + area.cell * place);
    if (heights[i]) area.datum = std::min(area.datum, *heights[i]);
  }
  if (!std::isfinite(area.datum)) area.datum = 0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const bool row_starts = i % area.columns == 0;
    area.ground[i] = heights[i] ? static_cast<float>(*heights[i] - area.datum) : row_starts ? 0 : area.ground[i - 1];
  }
}

}  // namespace

double mean_projection(double normal_cosine, double direction_cosine) {
  const double n = std::min(std::abs(normal_cosine), 1.0), w = std::min(std::abs(direction_cosine), 1.0);
  const double steady = n * w, swing = std::sqrt((1 - n * n) * (1 - w * w));
  if (steady >= swing) return steady;
  const double turn = std::acos(-steady / swing);  // where n.w changes sign
  return 2 / std::numbers::pi * (steady * (turn - std::numbers::pi / 2) + swing * std::sin(turn));
}

GrassArea measure_grass(const World& world) {
  const GroundHeight ground = ground_of(world);
  const Bounds bounds = bounds_of(world, ground);
  GrassArea area;
  if (!(bounds.height > 0)) return area;
  const glm::dvec2 edges = bounds.high - bounds.low + 2 * border * bounds.height;
  area.cell = std::max({bounds.height / cells_per_height, smallest_cell, std::sqrt(edges.x * edges.y / most_columns)});
  const glm::dvec2 cells = glm::ceil(edges / area.cell);
  area.columns = static_cast<std::uint32_t>(cells.x);
  area.rows = static_cast<std::uint32_t>(cells.y);
  area.slabs = slab_count;
  area.slab = bounds.height / slab_count;
  const glm::dvec2 middle = 0.5 * (bounds.low + bounds.high);
  area.extent = {middle - 0.5 * area.cell * cells, middle + 0.5 * area.cell * cells};
  level_ground(area, ground);

  constexpr int tilts = 64;
  float turned[tilts + 1][sky_rings];  // area turned to each ring per area and volume of a voxel
  for (int tilt = 0; tilt <= tilts; ++tilt)
    for (int ring = 0; ring < sky_rings; ++ring)
      turned[tilt][ring] = static_cast<float>(mean_projection(double(tilt) / tilts, ring_cosine(ring)) /
                                              (area.cell * area.cell * area.slab));
  area.projection.assign(slab_count * area.column_count() * sky_rings, 0);
  visit_all(world, area.cell / 2, [&](const Piece& piece) {
    const glm::dvec2 place = (glm::dvec2(piece.position) - area.extent.low) / area.cell;
    const auto column = static_cast<std::size_t>(std::clamp(place.x, 0.0, cells.x - 1));
    const auto row = static_cast<std::size_t>(std::clamp(place.y, 0.0, cells.y - 1));
    const double above = piece.position.z - area.datum - double(area.ground[row * area.columns + column]);
    const auto slab = static_cast<std::size_t>(std::clamp(above / area.slab, 0.0, slab_count - 1.0));
    const auto tilt = static_cast<std::size_t>(std::lround(std::min(std::abs(piece.normal_cosine), 1.0) * tilts));
    float* to = &area.projection[((slab * area.rows + row) * area.columns + column) * sky_rings];
    for (int ring = 0; ring < sky_rings; ++ring) to[ring] += static_cast<float>(piece.area) * turned[tilt][ring];
  });
  return area;
}

}  // namespace understory
