// crown-field: look-up and polynomial against another form in double, open ground, grids and numbers out of range.
#include "host/passes/crown_field.hpp"

#include <gtest/gtest.h>

#include <array>

#include "tests/reference/crown_field.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/fragments.hpp"

namespace understory {
namespace {

/// Two prototypes' fields one after another; owner 1 has the first, owner 2 the second, the others none.
struct Fields {
  std::vector<CrownFieldGrid> grids;
  std::vector<std::uint32_t> cells;
  std::vector<std::int32_t> owner_field{-1, 0, 1, -1};

  void add(glm::vec3 low, float cells_per_metre, glm::uvec3 count) {
    const auto first = static_cast<record_uint>(cells.size() / FIELD_WORDS);
    grids.push_back({low.x, low.y, low.z, cells_per_metre, count.x, count.y, count.z, first});
    cells.resize(cells.size() + std::size_t{FIELD_WORDS} * count.x * count.y * count.z);
  }
  CrownFieldTables upload(Device& device) const {
    CrownFieldTables tables;
    tables.owner_field = Buffer<std::int32_t>(device, std::span<const std::int32_t>(owner_field), "owner fields");
    tables.grids = Buffer<CrownFieldGrid>(device, std::span<const CrownFieldGrid>(grids), "grids");
    tables.cells = Buffer<std::uint32_t>(device, std::span<const std::uint32_t>(cells), "cells");
    return tables;
  }
};

Fields random_fields() {
  Fields fields;
  fields.add({-2, -1.5f, 0}, 2.5f, {9, 7, 16});
  fields.add({0.25f, -8, -1}, 0.75f, {3, 12, 5});
  for (std::size_t i = 0; i < fields.cells.size(); ++i)
    fields.cells[i] = static_cast<std::uint32_t>(Random(3, stream_of("cell"), i).bits());
  return fields;
}

/// The fragments' position and normal are those at rest.
Shaded shade(const std::vector<TestFragment>& fragments, const Fields& fields) {
  return shade_everywhere(fragments, [&](Device& device, int lanes, FragmentPlanes& planes, Buffer<float>& visibility) {
    planes.rest_position = {std::move(planes.position_x), std::move(planes.position_y), std::move(planes.position_z)};
    planes.rest_normal = {std::move(planes.normal_x), std::move(planes.normal_y), std::move(planes.normal_z)};
    for (Buffer<float>* plane : {&planes.position_x, &planes.position_y, &planes.position_z, &planes.normal_x,
                                 &planes.normal_y, &planes.normal_z})
      *plane = Buffer<float>(device, planes.padded_fragments, "not read");
    CrownFieldPass(device, lanes).run(planes, fields.upload(device), visibility);
  });
}

std::vector<TestFragment> fragments_around(const Fields& fields, std::size_t count, double beyond) {
  std::vector<TestFragment> all(count);
  for (std::size_t i = 0; i < count; ++i) {
    Random random(7, stream_of("field fragment"), i);
    TestFragment& f = all[i];
    f.owner = static_cast<std::uint32_t>(random.below(4));
    const CrownFieldGrid& grid = fields.grids[f.owner == 2 ? 1 : 0];
    const glm::dvec3 extent = glm::dvec3(grid.columns, grid.rows, grid.layers) / double(grid.cells_per_metre);
    const auto share = [&] { return random.uniform(-beyond, 1 + beyond); };
    f.position =
        glm::vec3(glm::dvec3(grid.low_x, grid.low_y, grid.low_z) + extent * glm::dvec3(share(), share(), share()));
    f.normal = random_direction(random);
  }
  return all;
}

TEST(CrownField, DeviceIsTheReference) {
  UNDERSTORY_NEEDS_DEVICE();
  const Fields fields = random_fields();
  for (const std::size_t size : odd_sizes) {
    const std::vector<TestFragment> fragments = fragments_around(fields, size, 0);
    const Shaded shaded = shade(fragments, fields);
    for (std::size_t i = 0; i < size; ++i) {
      const TestFragment& f = fragments[i];
      const std::int32_t field = fields.owner_field[f.owner];
      const double exact = field < 0
                               ? 1
                               : reference::crown_field(fields.grids[static_cast<std::size_t>(field)], fields.cells,
                                                        glm::dvec3(f.position), glm::dvec3(f.normal));
      EXPECT_NEAR(shaded.visibility[i], exact, 2e-5) << i;
      EXPECT_EQ(shaded.validity[i], 0u) << i;
    }
  }
}

TEST(CrownField, ClosedFormsOfTheOpenDomeAndOfASlope) {
  UNDERSTORY_NEEDS_DEVICE();
  Fields fields;
  fields.add({0, 0, 0}, 1, {2, 1, 1});
  fields.add({0, 0, 0}, 1, {1, 1, 1});
  for (std::size_t cell = 0; cell < 2; ++cell) fields.cells[FIELD_WORDS * cell] = 50u | 50u << 24;  // (1 + nz) / 2
  fields.cells[FIELD_WORDS * 2] = 50u;
  fields.cells[FIELD_WORDS * 2 + 2] = (256u - 30u) << 16;  // 0.5 - 0.3 qy
  std::vector<TestFragment> fragments;
  for (const double z : {-1.0, -0.3, 0.0, 0.8, 1.0})
    fragments.push_back({{1.3f, 0.2f, 0.9f}, glm::vec3(glm::dvec3(std::sqrt(1 - z * z), 0, z)), 1, 0, 0});
  for (const float y : {0.0f, 0.25f, 0.5f, 1.0f}) fragments.push_back({{0.5f, y, 0.5f}, {0, 0, 1}, 2, 0, 0});
  const Shaded shaded = shade(fragments, fields);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(shaded.visibility[i], (1 + fragments[i].normal.z) / 2, 1e-6);
  for (std::size_t i = 5; i < 9; ++i)
    EXPECT_NEAR(shaded.visibility[i], 0.5f - 0.3f * (2 * fragments[i].position.y - 1), 1e-6);
}

TEST(CrownField, OutsideItsGridIsMarkedAndTakesTheNearestCell) {
  UNDERSTORY_NEEDS_DEVICE();
  const Fields fields = random_fields();
  const std::vector<TestFragment> fragments = fragments_around(fields, 1003, 0.5);
  const Shaded shaded = shade(fragments, fields);
  for (std::size_t i = 0; i < fragments.size(); ++i) {
    const TestFragment& f = fragments[i];
    const std::int32_t field = fields.owner_field[f.owner];
    if (field < 0) {
      EXPECT_EQ(shaded.validity[i], 0u);
      continue;
    }
    const CrownFieldGrid& grid = fields.grids[static_cast<std::size_t>(field)];
    EXPECT_NEAR(shaded.visibility[i],
                reference::crown_field(grid, fields.cells, glm::dvec3(f.position), glm::dvec3(f.normal)), 2e-5);
    const glm::dvec3 place =
        (glm::dvec3(f.position) - glm::dvec3(grid.low_x, grid.low_y, grid.low_z)) * double(grid.cells_per_metre);
    const glm::dvec3 count(grid.columns, grid.rows, grid.layers);
    const bool inside = glm::all(glm::greaterThan(place, glm::dvec3(0))) && glm::all(glm::lessThan(place, count));
    const bool border = glm::any(glm::lessThan(glm::abs(place), glm::dvec3(0.01))) ||
                        glm::any(glm::lessThan(glm::abs(place - count), glm::dvec3(0.01)));
    if (!border) {
      EXPECT_EQ(shaded.validity[i], inside ? 0u : validity::outside_model) << i;
    }
  }
}

TEST(CrownField, GarbageStaysWithinBounds) {
  UNDERSTORY_NEEDS_DEVICE();
  Fields fields = random_fields();
  fields.grids[0].cells_per_metre = NAN;
  fields.grids[1].low_x = INFINITY;
  shade(garbage(4), fields);  // expects [0, 1]
}

TEST(CrownField, NamesWhatDoesNotFit) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  const FragmentPlanes planes = allocate_planes(device, 300, 1, false);
  Buffer<float> visibility(device, 512, "visibility");
  const std::string message = message_of(
      ErrorKind::unexpected, [&] { CrownFieldPass(device).run(planes, random_fields().upload(device), visibility); });
  EXPECT_NE(message.find("crown-field: plane rest point has 0 elements, 512 are needed"), std::string::npos) << message;
}

}  // namespace
}  // namespace understory
