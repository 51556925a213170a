// The benchmarks of `crown-field` and `crown-baked`: look-ups all over tables as large as those of a tree of half a
// million triangles. Every cell and texel holds the same function, so that the answer is known from the fragment alone.
#include <memory>

#include "bench/kernel_cases.hpp"
#include "host/passes/crown_baked.hpp"
#include "host/passes/crown_field.hpp"
#include "kernels/shared/crown_baked.h"

namespace understory {
namespace {

constexpr record_uint cells_per_edge = 64;
constexpr std::uint32_t texel_count = 3'200'000;
constexpr int field_steps[FIELD_COEFFICIENTS] = {45, 10, -5, 30, 4, -6, 8, 5, -7, 0, 0, 0};
constexpr std::uint32_t texel_corners[4] = {90, 150, 120, 180};  // V = 0.206 + 0.471 u + 0.235 v

Buffer<float> plane_of(Device& device, const BenchFragments& all,
                       const std::function<float(const BenchFragment&)>& of) {
  std::vector<float> values(all.planes.padded_fragments);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = of(all.at(i));
  return Buffer<float>(device, std::span<const float>(values), "rest point");
}

/// Rest position in crown radii about the crown's centre; the normal stays.
void add_rest_planes(Device& device, BenchFragments& all) {
  if (all.planes.rest_position[0].size() != 0) return;
  for (int axis = 0; axis < 3; ++axis) {
    const auto number = static_cast<std::size_t>(axis);
    all.planes.rest_position[number] = plane_of(device, all, [&, axis](const BenchFragment& f) {
      const std::int32_t row = all.owner_rows()[f.owner].crown;
      if (row < 0) return 0.0f;
      const CrownRecord& crown = all.crown_rows()[static_cast<std::size_t>(row)];
      return (f.position - glm::vec3(crown.x, crown.y, crown.z))[axis] / crown.radius;
    });
    all.planes.rest_normal[number] = plane_of(device, all, [axis](const BenchFragment& f) { return f.normal[axis]; });
  }
}

CrownFieldTables field_tables(Device& device, const BenchFragments& all) {
  std::vector<std::int32_t> owner_field;
  for (const Owner& owner : all.owner_rows()) owner_field.push_back(owner.crown >= 0 ? 0 : -1);
  const CrownFieldGrid grid{-1.2f,          -1.2f,          -1.2f,          float(cells_per_edge) / 2.4f,
                            cells_per_edge, cells_per_edge, cells_per_edge, 0};
  std::vector<std::uint32_t> cells(std::size_t{FIELD_WORDS} * cells_per_edge * cells_per_edge * cells_per_edge, 0);
  for (std::size_t i = 0; i < cells.size(); ++i)
    for (std::size_t byte = 0; byte < 4; ++byte)
      cells[i] |= static_cast<std::uint32_t>(static_cast<std::uint8_t>(field_steps[i % FIELD_WORDS * 4 + byte]))
                  << (8 * byte);
  CrownFieldTables tables;
  tables.owner_field = Buffer<std::int32_t>(device, std::span<const std::int32_t>(owner_field), "owner fields");
  tables.grids = Buffer<CrownFieldGrid>(device, std::span<const CrownFieldGrid>(&grid, 1), "grids");
  tables.cells = Buffer<std::uint32_t>(device, std::span<const std::uint32_t>(cells), "cells");
  return tables;
}

std::uint32_t fraction(float share) { return static_cast<std::uint32_t>((0.5f + 0.5f * share) * TEXEL_FRACTIONS); }

/// Between 0.6 and 1.4.
std::uint32_t tilt_steps(float share) { return static_cast<std::uint32_t>((1 + 0.4f * share) * TILT_STEPS); }

/// Neighbours see the same leaf or one near it: texels of one neighbourhood per tile, taken by the tile's owner and
/// place; fractions and tilt come from the normal.
void add_texel_planes(Device& device, BenchFragments& all) {
  std::vector<std::uint32_t> texel(all.planes.padded_fragments), place(all.planes.padded_fragments);
  for (std::size_t i = 0; i < texel.size(); ++i) {
    const BenchFragment f = all.at(i);
    const bool plant = all.owner_rows()[f.owner].crown >= 0;
    const std::size_t tile = i / all.planes.row_length / 16 * all.planes.row_length + i % all.planes.row_length / 16;
    const std::size_t leaf = tile * 7919 + i % 16 / 4 * 97 + i / all.planes.row_length % 16 / 4 * 31;
    texel[i] = plant ? static_cast<std::uint32_t>(leaf * 6 % texel_count) : NO_TEXEL;
    place[i] = fraction(f.normal.x) | fraction(f.normal.y) << 12 | tilt_steps(f.normal.z) << 24;
  }
  all.planes.texel = Buffer<std::uint32_t>(device, std::span<const std::uint32_t>(texel), "texel");
  all.planes.texel_place = Buffer<std::uint32_t>(device, std::span<const std::uint32_t>(place), "texel place");
}

double field_reference(const BenchFragments& all, const BenchFragment& f) {
  if (all.owner_rows()[f.owner].crown < 0) return 1;
  const auto coefficient = [](int number) { return double(field_steps[number]); };
  const glm::dvec3 n(f.normal);
  return as_visibility(double(FIELD_STEP) * FIELD_VALUE(coefficient, n.x, n.y, n.z, 0.0, 0.0, 0.0));
}

double baked_reference(const BenchFragments& all, const BenchFragment& f) {
  if (all.owner_rows()[f.owner].crown < 0) return 1;
  const double u = fraction(f.normal.x) / 4095.0, v = fraction(f.normal.y) / 4095.0;
  const double tilt = tilt_steps(f.normal.z) / 128.0;
  const auto corner = [](int number) { return double(texel_corners[number]); };
  return texel_visibility(corner(0), corner(1), corner(2), corner(3), u, v, tilt);
}

}  // namespace

KernelCase crown_field_case() {
  return visibility_case(
      "crown-field", 1e-5,
      [](Device& device, BenchFragments& all, Buffer<float>& visibility) {
        add_rest_planes(device, all);
        const auto tables = std::make_shared<CrownFieldTables>(field_tables(device, all));
        return [&all, &visibility, tables, pass = std::make_shared<CrownFieldPass>(device)] {
          pass->run(all.planes, *tables, visibility);
        };
      },
      field_reference);
}

KernelCase crown_baked_case() {
  return visibility_case(
      "crown-baked", 1e-5,
      [](Device& device, BenchFragments& all, Buffer<float>& visibility) {
        add_texel_planes(device, all);
        const std::vector<std::uint32_t> values(
            texel_count, texel_corners[0] | texel_corners[1] << 8 | texel_corners[2] << 16 | texel_corners[3] << 24);
        const auto texels =
            std::make_shared<Buffer<std::uint32_t>>(device, std::span<const std::uint32_t>(values), "texels");
        return [&all, &visibility, texels, pass = std::make_shared<CrownBakedPass>(device)] {
          pass->run(all.planes, *texels, visibility);
        };
      },
      baked_reference);
}

}  // namespace understory
