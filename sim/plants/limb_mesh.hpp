// The step between a plant's shape and its prototype: triangles whose vertices know the limb that carries them.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <string>
#include <vector>

#include "sim/prototype.hpp"

namespace understory {

/// A leaf at full flutter has turned about its petiole so far that a point moves by this share of its distance.
inline constexpr float full_flutter = 0.3f;

struct LimbMesh {
  std::vector<glm::vec3> positions;         // m, z up
  std::vector<std::uint32_t> limb;          // per vertex; the vertices of a triangle share their limb
  std::vector<glm::vec3> flutter;           // per vertex: displacement at full flutter, m; 0 on wood
  std::vector<std::uint8_t> flutter_phase;  // per vertex: 1/256 turn, one value per leaf
  std::map<SurfaceClass, std::vector<std::uint32_t>> triangles;  // 3 indices per triangle
  std::vector<Limb> limbs;                                       // parents before children

  /// Adds a vertex and returns its index.
  std::uint32_t add_vertex(glm::vec3 position, std::uint32_t of_limb, glm::vec3 at_full_flutter = glm::vec3(0),
                           std::uint8_t phase = 0);
};

/// Sets every limb's `reach` from the wood that it carries.
void measure_reach(LimbMesh& mesh);

/// Groups vertices by limb into padded blocks and triangles by class, in order of their limbs; drops triangles without
/// area and vertices without triangle. No crown. Throws Error(invalid_input) when no triangle is left.
Prototype assemble(const std::string& name, const LimbMesh& mesh);

}  // namespace understory
