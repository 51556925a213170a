// Bakes `crown-field`: what the surfaces of a plant see of the sky, as a smooth function of place and normal in a grid
// around the plant at rest (kernels/shared/crown_field.h).
//
// The fit is to the surfaces themselves, not to free space: rays start on leaves and wood, so that a surface's own
// neighbours are in the mean. A point counts as often as it is seen from outside (one ray in a cosine-weighted
// direction gets out), which is the mean that pictures show and leaves out the insides of stems.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "kernels/shared/crown_field.h"
#include "sim/prototype.hpp"
#include "sim/scene.hpp"

namespace understory {

struct CrownFieldOptions {
  Sky sky = Sky::dome;
  int cells = 64;  // along the longest edge of the plant's box; cells are cubes
  double rays_per_triangle = 18;
  double least_rays = 6e5, most_rays = 6e6;  // whatever the number of triangles
  std::uint32_t seed = 1;
};

struct CrownField {
  CrownFieldGrid grid{};             // first_cell 0
  std::vector<std::uint32_t> cells;  // FIELD_WORDS each
};

/// V_c; under `dome` the ground is at the prototype's z = 0 and hides all below the horizon. The same bytes for any
/// number of threads. Cells without a surface hold what their surroundings say. A prototype without area: an open
/// field.
CrownField bake_crown_field(const Prototype& prototype, const CrownFieldOptions& options);

/// V of the field at a place (m, prototype frame) on a surface of unit normal.
double field_visibility(const CrownField& field, glm::vec3 position, glm::vec3 normal);

}  // namespace understory
