// Bodies with occlusion grids for tests: what they are, where they stand, and their tables on the device.
#pragma once
#include <glm/gtc/quaternion.hpp>
#include <vector>

#include "host/passes/tile_grids.hpp"
#include "host/trace/grid_bake.hpp"
#include "sim/shapes.hpp"
#include "tests/support/fragments.hpp"

namespace understory {

/// Triangles of one body, in its own frame.
struct TestMesh {
  std::vector<glm::vec3> vertices;
  std::vector<std::uint32_t> triangles;

  TestMesh& add(const RawMesh::Part& part, glm::vec3 at = glm::vec3(0)) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (const glm::vec3& p : part.positions) vertices.push_back(p + at);
    for (const std::uint32_t index : part.triangles) triangles.push_back(first + index);
    return *this;
  }
};

inline TestMesh cube(double edge = 1) { return TestMesh().add(box_part(glm::dvec3(edge))); }

/// A table: concave, with four legs; stands on z = 0.
inline TestMesh table() {
  TestMesh mesh;
  mesh.add(box_part({1.6, 1, 0.1}), {0, 0, 0.95f});
  for (const float x : {-0.7f, 0.7f})
    for (const float y : {-0.4f, 0.4f}) mesh.add(box_part({0.1, 0.1, 0.9}), {x, y, 0.45f});
  return mesh;
}

struct GridBody {
  OcclusionGrid grid;
  glm::dmat3 rotation{1};
  glm::dvec3 position{0};
  std::int32_t group = -1;

  GridRecord record(std::uint32_t first) const {
    GridRecord r{};
    const glm::dmat3 to_body = glm::transpose(rotation);
    for (int row = 0; row < 3; ++row) {
      const double scale = (grid.size[static_cast<std::size_t>(row)] - 1) / double(grid.high[row] - grid.low[row]);
      double constant = -double(grid.low[row]);
      for (int axis = 0; axis < 3; ++axis) {
        r.to_grid[4 * row + axis] = static_cast<float>(scale * to_body[axis][row]);
        r.axes[4 * row + axis] = static_cast<float>(rotation[axis][row]);
        constant -= to_body[axis][row] * position[axis];
      }
      r.to_grid[4 * row + 3] = static_cast<float>(scale * constant);
    }
    r.first = first;
    r.width = grid.size[0];
    r.height = grid.size[1];
    r.depth = grid.size[2];
    r.group = group;
    r.border = grid.border;
    return r;
  }
};

/// Every body has samples of its own.
inline GridTable upload_grids(Device& device, const std::vector<GridBody>& bodies, bool cone) {
  std::vector<std::uint8_t> samples;
  std::vector<GridRecord> records;
  for (const GridBody& body : bodies) {
    records.push_back(body.record(static_cast<std::uint32_t>(samples.size() / (cone ? 4 : 1))));
    const std::vector<std::uint8_t> packed = cone ? packed_cone(body.grid) : packed_share(body.grid);
    samples.insert(samples.end(), packed.begin(), packed.end());
  }
  if (samples.empty()) samples.resize(8);
  GridTable table(device, samples);
  table.place(records);
  return table;
}

/// Coarse grids and few rays: for tests of look-ups, not of accuracy.
inline GridSettings coarse(GridSize size = {9, 10, 11}) {
  GridSettings settings;
  settings.size = size;
  settings.rays = 64;
  return settings;
}

/// Some bodies near the origin, turned any way, of groups 0, 1, ...
inline std::vector<GridBody> random_bodies(std::size_t count, GridBorder border = GridBorder::fade) {
  GridSettings settings = coarse();
  settings.border = border;
  const TestMesh meshes[] = {cube(), table(), TestMesh().add(ellipsoid_part({0.5, 1, 1.4}))};
  std::vector<OcclusionGrid> grids;
  for (const TestMesh& mesh : meshes) grids.push_back(bake_grid(mesh.vertices, mesh.triangles, settings));
  std::vector<GridBody> bodies;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(7, stream_of("grid body"), i);
    GridBody body;
    body.grid = grids[i % 3];
    body.rotation =
        glm::mat3_cast(glm::angleAxis(random.uniform(0, 6), glm::normalize(glm::dvec3(random_direction(random)))));
    body.position = {random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-1, 1)};
    body.group = static_cast<std::int32_t>(i);
    bodies.push_back(body);
  }
  return bodies;
}

/// Owners: 0 background, 1 of no group, then one for each of `groups`.
inline OwnerTables body_owners(Device& device, std::size_t groups) {
  std::vector<Owner> owners(2 + groups);
  for (std::size_t group = 0; group < groups; ++group) owners[2 + group].group = static_cast<std::int32_t>(group);
  return upload_owners(device, owners);
}

/// Fragments among the bodies, a fifth of them on one.
inline std::vector<TestFragment> fragments_among(std::size_t count, std::size_t groups) {
  std::vector<TestFragment> all;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(9, stream_of("grid fragment"), i);
    TestFragment fragment;
    fragment.position = glm::vec3(glm::dvec3(random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-3, 3)));
    fragment.normal = random_direction(random);
    fragment.owner = i % 5 == 0 ? 2 + static_cast<std::uint32_t>(random.below(groups)) : 1;
    all.push_back(fragment);
  }
  return all;
}

}  // namespace understory
