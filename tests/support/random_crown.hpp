// Leaves anywhere in a ball, any way round: the plant for which crown-transmittance is exact on average.
#pragma once
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "sim/crown.hpp"
#include "sim/plants/species.hpp"
#include "sim/random.hpp"

namespace understory {

/// Equilateral leaves in the unit ball about (0, 0, 1), as large as k R = `optical` by leaf area asks for: k = LAD/2.
inline Prototype random_crown_prototype(int leaves, double optical) {
  const double area = optical * 8 * std::numbers::pi / (3 * leaves), edge = std::sqrt(4 * area / std::sqrt(3.0));
  RawMesh mesh;
  RawMesh::Part& part = mesh.parts.emplace_back();
  part.surface = SurfaceClass::leaf;
  for (int leaf = 0; leaf < leaves; ++leaf) {
    Random random(9, stream_of("random crown leaf"), static_cast<std::uint64_t>(leaf));
    const auto direction = [&] {
      const double z = random.uniform(-1, 1), turn = random.uniform(0, 2 * std::numbers::pi),
                   flat = std::sqrt(1 - z * z);
      return glm::dvec3(flat * std::cos(turn), flat * std::sin(turn), z);
    };
    const glm::dvec3 centre = glm::dvec3(0, 0, 1) + std::cbrt(random.uniform()) * direction(), normal = direction();
    const glm::dvec3 a = glm::normalize(glm::cross(normal, direction())), b = glm::cross(normal, a);
    const auto next = static_cast<std::uint32_t>(part.positions.size());
    for (int corner = 0; corner < 3; ++corner) {
      const double turn = 2 * std::numbers::pi * corner / 3;
      part.positions.emplace_back(centre + edge / std::sqrt(3.0) * (std::cos(turn) * a + std::sin(turn) * b));
      part.triangles.push_back(next + static_cast<std::uint32_t>(corner));
    }
  }
  Prototype prototype = rigid_prototype("random crown", mesh);
  prototype.crown = fit_crown(prototype);
  return prototype;
}

}  // namespace understory
