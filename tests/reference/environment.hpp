// Ambient light of one fragment in double, in another form than the kernels': light is counted, not divided; cones are
// looked up by going through all nodes of the tables; the library's functions throughout.
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "sim/environment.hpp"
#include "tests/reference/cone.hpp"

namespace understory::reference {

/// The square's place of a direction: the octahedron |x| + |y| + |z| = 1 seen from above, its lower half folded out.
inline glm::dvec2 folded_out(glm::dvec3 d) {
  const glm::dvec3 on = d / (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
  if (on.z >= 0) return glm::dvec2(on) * 0.5 + 0.5;
  const double x = (1 - std::abs(on.y)) * (on.x < 0 ? -1 : 1), y = (1 - std::abs(on.x)) * (on.y < 0 ? -1 : 1);
  return glm::dvec2(x, y) * 0.5 + 0.5;
}

/// Sum over all nodes of tent functions: bilinear interpolation.
inline glm::dvec3 in_square(const std::vector<float>& table, std::size_t first, std::uint32_t nodes, glm::dvec3 d) {
  const glm::dvec2 place = folded_out(d) * double(nodes - 1);
  glm::dvec3 sum(0);
  for (std::uint32_t row = 0; row < nodes; ++row)
    for (std::uint32_t column = 0; column < nodes; ++column) {
      const double weight = std::max(0.0, 1 - std::abs(place.x - column)) * std::max(0.0, 1 - std::abs(place.y - row));
      const float* node = table.data() + 4 * (first + std::size_t(row) * nodes + column);
      if (weight > 0) sum += weight * glm::dvec3(node[0], node[1], node[2]);
    }
  return sum;
}

inline glm::dvec3 in_cone(const PrefilteredEnvironment& e, glm::dvec3 axis, double aperture) {
  const double half_angle = std::acos(1 - 2 * aperture);
  const double level = std::sin(half_angle / 2) * (e.size.cone_levels - 1);
  const auto lower = std::min(static_cast<std::uint32_t>(level), e.size.cone_levels - 2);
  const std::size_t square = std::size_t(e.size.cone_nodes) * e.size.cone_nodes;
  return glm::mix(in_square(e.cones, lower * square, e.size.cone_nodes, axis),
                  in_square(e.cones, (lower + 1) * square, e.size.cone_nodes, axis), level - lower);
}

struct ConeOfFragment {
  glm::dvec3 axis{0, 0, 1};
  double aperture = 0, share = 0;
};

/// `visibility` at most 1 - share.
inline glm::dvec3 environment(const PrefilteredEnvironment& e, glm::dvec3 normal, double visibility,
                              const ConeOfFragment& cone) {
  const double rest = cone.share < 1 ? visibility / (1 - cone.share) : 0;
  const glm::dvec3 open = in_square(e.normals, 0, e.size.normal_nodes, normal);
  if (cone.share == 0) return rest * open;
  return rest * glm::max(glm::dvec3(0), open - cone.share * in_cone(e, cone.axis, cone.aperture));
}

}  // namespace understory::reference
