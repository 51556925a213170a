// Worlds made by hand, small enough to check on paper: triangles that stand where they are given.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "kernels/shared/records.h"
#include "sim/prototype.hpp"
#include "sim/world.hpp"

namespace understory {

/// One rigid limb with these vertices and triangles, of owner row 1.
inline World world_of_triangles(const std::vector<glm::vec3>& vertices, const std::vector<std::uint32_t>& triangles) {
  Prototype prototype;
  for (const glm::vec3& v : vertices) {
    prototype.vertices.x.push_back(v.x);
    prototype.vertices.y.push_back(v.y);
    prototype.vertices.z.push_back(v.z);
  }
  const std::size_t padded = (vertices.size() + vertex_block - 1) / vertex_block * vertex_block;
  for (std::vector<float>* plane : {&prototype.vertices.x, &prototype.vertices.y, &prototype.vertices.z})
    plane->resize(padded, plane->back());
  for (std::vector<std::int8_t>* plane :
       {&prototype.vertices.flutter_x, &prototype.vertices.flutter_y, &prototype.vertices.flutter_z})
    plane->resize(padded, 0);
  prototype.vertices.flutter_phase.resize(padded, 0);
  prototype.vertices.block_limb.resize(padded / vertex_block, 0);
  prototype.limbs.emplace_back();
  prototype.triangles = triangles;
  prototype.runs = {{SurfaceClass::terrain, 0, prototype.triangle_count()}};
  World world;
  world.prototypes = {prototype};
  Instance instance;
  instance.run_owner = {1};
  world.instances = {instance};
  world.owners.resize(2);
  world.owners[1].surface = SurfaceClass::terrain;
  return world;
}

/// A limb that leaves rest positions where they are, seen from `eye`.
inline LimbPose standing_limb(glm::vec3 eye = glm::vec3(0)) {
  LimbPose limb{};
  for (int i = 0; i < 3; ++i) {
    limb.to_limb[5 * i] = limb.to_scene[5 * i] = 1;
    limb.to_scene[4 * i + 3] = -eye[i];
  }
  return limb;
}

}  // namespace understory
