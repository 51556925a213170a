// Bodies with traced occlusion grids for tests, and fragments among them.
#pragma once
#include <glm/gtc/quaternion.hpp>
#include <vector>

#include "host/trace/grid_bake.hpp"
#include "host/trace/own_shadow_bake.hpp"
#include "sim/shapes.hpp"
#include "tests/support/fragments.hpp"
#include "tests/support/grid_bodies.hpp"

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

/// Coarse grids and few rays: for tests of look-ups, not of accuracy.
inline GridSettings coarse(GridSize size = {9, 10, 11}) {
  GridSettings settings;
  settings.size = size;
  settings.rays = 64;
  return settings;
}

/// Some bodies near the origin, turned any way, of groups 0, 1, ...; the table's samples crowd about its middle, and it
/// alone shades itself.
inline std::vector<GridBody> random_bodies(std::size_t count, GridBorder border = GridBorder::fade) {
  GridSettings settings = coarse();
  settings.border = border;
  const TestMesh meshes[] = {cube(), table(), TestMesh().add(ellipsoid_part({0.5, 1, 1.4}))};
  std::vector<OcclusionGrid> grids;
  for (const TestMesh& mesh : meshes) {
    settings.stretch = grids.size() == 1 ? 2 : 0;
    grids.push_back(bake_grid(mesh.vertices, mesh.triangles, settings));
  }
  const OwnShadow own = bake_own_shadow(meshes[1].vertices, meshes[1].triangles, 16, 1);
  std::vector<GridBody> bodies;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(7, stream_of("grid body"), i);
    GridBody body;
    body.grid = grids[i % 3];
    if (i % 3 == 1) body.own = own;
    body.rotation =
        glm::mat3_cast(glm::angleAxis(random.uniform(0, 6), glm::normalize(glm::dvec3(random_direction(random)))));
    body.position = {random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-1, 1)};
    body.group = static_cast<std::int32_t>(i);
    bodies.push_back(body);
  }
  return bodies;
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
