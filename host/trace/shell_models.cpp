#include "host/trace/shell_models.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "host/trace/directions.hpp"
#include "kernels/shared/sphere_cap.h"

namespace understory {
namespace {

UnitShell unit_sphere(const glm::dvec3& centre, double radius) { return {centre, glm::dmat3(1 / radius)}; }

UnitShell unit_ellipsoid(const CrownShell& crown) {
  glm::dmat3 scale(1);
  for (int axis = 0; axis < 3; ++axis) scale[axis][axis] = 1 / double(crown.ellipsoid_radii[axis]);
  return {glm::dvec3(crown.ellipsoid_centre), scale * glm::transpose(glm::dmat3(crown.ellipsoid_axes))};
}

/// f V_cap in the frame of the unit sphere, back in m^3.
double cap_weight(const UnitShell& shell, const glm::dvec3& position, const glm::dvec3& normal) {
  const glm::dvec3 p = shell.to_unit * (position - shell.centre);
  const glm::dvec3 n = glm::normalize(glm::transpose(glm::inverse(shell.to_unit)) * normal);
  return cap_occluders(p.x, p.y, p.z, n.x, n.y, n.z, 1.0) / glm::determinant(shell.to_unit);
}

/// Where start + t step is within the unit sphere, t >= 0; false: nowhere.
bool within_unit_sphere(const glm::dvec3& start, const glm::dvec3& step, double& enter, double& leave) {
  const double a = glm::dot(step, step), b = glm::dot(start, step), c = glm::dot(start, start) - 1;
  const double root = b * b - a * c;
  if (root <= 0) return false;
  enter = std::max((-b - std::sqrt(root)) / a, 0.0);
  leave = (-b + std::sqrt(root)) / a;
  return leave > enter;
}

}  // namespace

std::vector<UnitShell> shells_of(const CrownShell& crown, CrownShape shape, double scale) {
  std::vector<UnitShell> shells;
  if (shape == CrownShape::sphere) shells.push_back(unit_sphere(glm::dvec3(crown.sphere_centre), crown.sphere_radius));
  if (shape == CrownShape::ellipsoid) shells.push_back(unit_ellipsoid(crown));
  if (shape == CrownShape::shells)
    for (const glm::vec4& shell : crown.shells) shells.push_back(unit_sphere(glm::dvec3(shell), shell.w));
  for (UnitShell& shell : shells) shell.to_unit /= scale;
  return shells;
}

std::vector<double> cap_weights(const CrownShell& crown, const CrownPoints& points, CapShell shell) {
  const UnitShell sphere = shells_of(crown, CrownShape::sphere).front(), ellipsoid = unit_ellipsoid(crown);
  std::vector<double> weights;
  for (std::size_t i = 0; i < points.positions.size(); ++i) {
    const glm::dvec3 position(points.positions[i]), normal(points.normals[i]);
    const auto of = [&](const UnitShell& unit) { return cap_weight(unit, position, normal); };
    UnitShell nearest = sphere;
    if (!crown.shells.empty()) {
      const glm::vec4& owner = crown.shells[nearest_shell_of(crown, position)];
      nearest = unit_sphere(glm::dvec3(owner), owner.w);
    }
    switch (shell) {
      case CapShell::sphere:
        weights.push_back(of(sphere));
        break;
      case CapShell::ellipsoid:
        weights.push_back(of(ellipsoid));
        break;
      case CapShell::nearest:
        weights.push_back(of(nearest));
        break;
      case CapShell::levels:
        weights.push_back(crown.shells.empty() ? of(sphere) : of(sphere) + of(nearest));
        break;
    }
  }
  return weights;
}

ShellChords::ShellChords(const std::vector<UnitShell>& shells, const CrownPoints& points)
    : points_(points.positions.size()), shells_(shells.size()), chords_(points_ * shells_ * directions) {
  std::vector<glm::vec3> sky;
  for (std::uint32_t i = 0; i < directions; ++i) sky.push_back(cosine_hemisphere(scrambled_sobol(i, 3)));
  tbb::parallel_for(std::size_t(0), points_, [&](std::size_t point) {
    const glm::mat3 frame = frame_about(points.normals[point]);
    for (std::size_t j = 0; j < shells_; ++j) {
      const glm::dvec3 start = shells[j].to_unit * (glm::dvec3(points.positions[point]) - shells[j].centre);
      for (std::size_t i = 0; i < directions; ++i) {
        double enter = 0, leave = 0;
        if (within_unit_sphere(start, shells[j].to_unit * glm::dvec3(frame * sky[i]), enter, leave))
          chords_[(point * shells_ + j) * directions + i] = static_cast<float>(leave - enter);
      }
    }
  });
}

std::vector<double> ShellChords::visibility(double k) const {
  std::vector<double> all(points_, 1);
  const auto rate = static_cast<float>(k);
  tbb::parallel_for(std::size_t(0), points_, [&](std::size_t point) {
    for (std::size_t j = 0; j < shells_; ++j) {
      const float* chord = chords_.data() + (point * shells_ + j) * directions;
      float sum = 0;
      for (std::size_t i = 0; i < directions; ++i) sum += std::exp(-rate * chord[i]);
      all[point] *= double(sum) / directions;
    }
  });
  return all;
}

std::vector<Chord> ellipsoid_chords(const CrownShell& crown, const std::vector<CrownLine>& lines) {
  const UnitShell shell = unit_ellipsoid(crown);
  std::vector<Chord> chords;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    double enter = 0, leave = 0;
    if (within_unit_sphere(shell.to_unit * (glm::dvec3(lines[i].origin) - shell.centre),
                           shell.to_unit * glm::dvec3(lines[i].direction), enter, leave))
      chords.push_back({i, static_cast<float>(enter), static_cast<float>(leave)});
  }
  return chords;
}

DensityGrid density_grid(const Prototype& prototype) {
  constexpr float most_cells = 16;
  DensityGrid grid;
  const glm::vec3 size = prototype.high - prototype.low;
  const float cell = std::max({size.x, size.y, size.z}) / most_cells;
  if (!(cell > 0)) return grid;
  grid.cells = glm::max(glm::ivec3(glm::ceil(size / cell - 1e-4f)), glm::ivec3(1));
  grid.low = prototype.low;
  grid.high = prototype.low + cell * glm::vec3(grid.cells);
  std::vector<double> area(static_cast<std::size_t>(grid.cells.x * grid.cells.y * grid.cells.z), 0);
  const VertexBlocks& blocks = prototype.vertices;
  for (const TriangleRun& run : prototype.runs)
    for (std::uint32_t i = 3 * run.first; i < 3 * (run.first + run.count); i += 3) {
      const auto corner = [&](std::uint32_t k) {
        const std::uint32_t v = prototype.triangles[i + k];
        return glm::vec3(blocks.x[v], blocks.y[v], blocks.z[v]);
      };
      const glm::vec3 a = corner(0), b = corner(1), c = corner(2);
      const glm::ivec3 at =
          glm::clamp(glm::ivec3(((a + b + c) / 3.0f - grid.low) / cell), glm::ivec3(0), grid.cells - 1);
      const double share = run.surface == SurfaceClass::wood ? 0.25 : 0.5;
      area[static_cast<std::size_t>((at.z * grid.cells.y + at.y) * grid.cells.x + at.x)] +=
          share * double(glm::length(glm::cross(b - a, c - a)));
    }
  for (const double sum : area) grid.density.push_back(static_cast<float>(sum / std::pow(double(cell), 3)));
  return grid;
}

}  // namespace understory
