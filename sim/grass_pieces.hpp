// The blades of a scene's grass in small pieces, blade by blade.
#pragma once
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>

#include "sim/world.hpp"

namespace understory {

/// A piece of a blade or mesh, small beside a cell.
struct GrassPiece {
  glm::dvec3 position;   // relative to the origin, m
  double area;           // one-sided, m^2; of stems and ears half their surface
  double normal_cosine;  // to the vertical
  std::uint32_t blade;   // the same for pieces that hang together; another one than the blade's before
};

/// Every piece of grass in the scene, always in the same order: fields in the mean wind, and plants of a mesh with
/// blades, at rest, their triangles cut into pieces no wider than `widest`, m.
void visit_grass(const World& world, double widest, const std::function<void(const GrassPiece&)>& visit);

}  // namespace understory
