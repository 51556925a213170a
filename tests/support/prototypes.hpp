// What every prototype promises (sim/prototype.hpp), as one check; and its vertices as vectors.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>

#include "sim/prototype.hpp"

namespace understory {

inline glm::vec3 position_of(const Prototype& prototype, std::uint32_t vertex) {
  return {prototype.vertices.x[vertex], prototype.vertices.y[vertex], prototype.vertices.z[vertex]};
}

/// Displacement at full flutter, m.
inline glm::vec3 flutter_of(const Prototype& prototype, std::uint32_t vertex) {
  const VertexBlocks& blocks = prototype.vertices;
  return prototype.flutter_scale / 127 *
         glm::vec3(blocks.flutter_x[vertex], blocks.flutter_y[vertex], blocks.flutter_z[vertex]);
}

inline void expect_sound_vertices(const Prototype& prototype) {
  const VertexBlocks& blocks = prototype.vertices;
  ASSERT_EQ(blocks.x.size(), vertex_block * blocks.block_limb.size());
  for (const auto* list : {&blocks.y, &blocks.z}) ASSERT_EQ(list->size(), blocks.x.size());
  for (const auto* list : {&blocks.flutter_x, &blocks.flutter_y, &blocks.flutter_z}) {
    ASSERT_EQ(list->size(), blocks.x.size());
  }
  ASSERT_EQ(blocks.flutter_phase.size(), blocks.x.size());
  for (std::uint32_t i = 0; i < blocks.x.size(); ++i) {
    const glm::vec3 p = position_of(prototype, i);
    ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) << "vertex " << i;
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_GE(p[axis], prototype.low[axis]);
      ASSERT_LE(p[axis], prototype.high[axis]);
    }
  }
  for (std::uint32_t limb : blocks.block_limb) ASSERT_LT(limb, prototype.limbs.size());
}

inline void expect_sound_triangles(const Prototype& prototype) {
  std::uint32_t covered = 0;
  for (const TriangleRun& run : prototype.runs) {
    ASSERT_EQ(run.first, covered) << "runs follow each other";
    ASSERT_GT(run.count, 0u);
    covered += run.count;
  }
  ASSERT_EQ(covered, prototype.triangle_count()) << "runs cover all triangles";
  const std::vector<std::uint32_t>& block_limb = prototype.vertices.block_limb;
  for (std::uint32_t t = 0; t < prototype.triangle_count(); ++t) {
    const std::uint32_t* corner = &prototype.triangles[3 * t];
    for (int k = 0; k < 3; ++k) ASSERT_LT(corner[k], prototype.vertices.x.size());
    ASSERT_EQ(block_limb[corner[0] / vertex_block], block_limb[corner[1] / vertex_block]) << "triangle " << t;
    ASSERT_EQ(block_limb[corner[0] / vertex_block], block_limb[corner[2] / vertex_block]) << "triangle " << t;
    const glm::dvec3 a(position_of(prototype, corner[0])), b(position_of(prototype, corner[1])),
        c(position_of(prototype, corner[2]));
    ASSERT_GT(glm::length(glm::cross(b - a, c - a)), 0) << "triangle " << t << " has no area";
  }
}

inline void expect_sound_limbs(const Prototype& prototype) {
  ASSERT_FALSE(prototype.limbs.empty());
  for (std::size_t i = 0; i < prototype.limbs.size(); ++i) {
    const Limb& limb = prototype.limbs[i];
    ASSERT_LT(limb.parent, static_cast<std::int32_t>(i)) << "parents before children";
    ASSERT_NEAR(glm::length(limb.axis), 1, 1e-5) << "limb " << i;
    ASSERT_GT(limb.length, 0) << "limb " << i;
    ASSERT_GE(limb.reach, 0) << "limb " << i;
    ASSERT_TRUE(std::isfinite(limb.reach)) << "limb " << i;
    ASSERT_GT(limb.flexibility, 0) << "limb " << i;
    ASSERT_GE(limb.delay, 0) << "limb " << i;
  }
  for (const TriangleRun& run : prototype.runs) {
    if (run.surface != SurfaceClass::wood) continue;
    for (std::uint32_t i = 3 * run.first; i < 3 * (run.first + run.count); ++i) {
      const std::uint32_t vertex = prototype.triangles[i];
      const Limb& limb = prototype.limbs[prototype.vertices.block_limb[vertex / vertex_block]];
      const glm::vec3 offset = position_of(prototype, vertex) - limb.base;
      const float away = glm::length(offset - glm::dot(offset, limb.axis) * limb.axis);
      ASSERT_TRUE(limb.kind == SwayKind::rigid || away <= limb.reach * 1.0001f + 1e-5f) << "vertex " << vertex;
    }
  }
}

inline void expect_crown_holds_foliage(const Prototype& prototype) {
  const CrownShell& crown = prototype.crown;
  for (const TriangleRun& run : prototype.runs) {
    if (run.surface != SurfaceClass::leaf && run.surface != SurfaceClass::blade) continue;
    for (std::uint32_t i = 3 * run.first; i < 3 * (run.first + run.count); ++i) {
      const glm::vec3 p = position_of(prototype, prototype.triangles[i]);
      ASSERT_LE(glm::distance(p, crown.sphere_centre), crown.sphere_radius * 1.0001f);
      const glm::vec3 unit =
          glm::transpose(crown.ellipsoid_axes) * (p - crown.ellipsoid_centre) / crown.ellipsoid_radii;
      ASSERT_LE(glm::length(unit), 1.0001f);
    }
  }
}

inline void expect_sound(const Prototype& prototype) {
  expect_sound_vertices(prototype);
  expect_sound_triangles(prototype);
  expect_sound_limbs(prototype);
  expect_crown_holds_foliage(prototype.crown.sphere_radius > 0 ? prototype : Prototype{});
}

}  // namespace understory
