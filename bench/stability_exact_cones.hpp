// Cones put together by the kernels' own text (kernels/shared/running_cone.h), in double and with the library's
// arc tangent in place of the polynomial.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace understory {

/// What one body occludes around a fragment, world axes (Occluded of kernels/shared/cone.h).
struct ExactOccluded {
  double share = 0;
  glm::dvec3 direction{0};
};

/// V of `grid-cone` (`paper`: of `grid-cone-paper`) under the rule multiply, simple, merge or union.
double exact_grid_cone(const std::vector<ExactOccluded>& bodies, glm::dvec3 normal, const std::string& rule,
                       bool paper);

}  // namespace understory
