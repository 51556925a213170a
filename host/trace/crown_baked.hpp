// Bakes `crown-baked`: what each face of a plant at rest sees of the sky, in texels on both of its sides
// (kernels/shared/crown_baked.h).
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "sim/prototype.hpp"
#include "sim/scene.hpp"

namespace understory {

struct CrownBakedOptions {
  Sky sky = Sky::dome;
  double rays_per_triangle = 440;  // mean, both sides together; sides that nobody can see end early
  double most_rays = 1e8;          // whatever the number of triangles
  double texels_per_triangle = 3;  // mean, of one side; large faces get more of them, crossed cards too
  std::uint32_t seed = 1;
};

struct CrownBaked {
  std::vector<std::array<std::uint32_t, 2>> faces;  // per triangle of the prototype
  std::vector<std::uint32_t> texels;
};

/// V_c; under `dome` the ground is at the prototype's z = 0 and hides all below the horizon. The same bytes for any
/// number of threads. Noise is drawn towards the plant's own field (crown_field.hpp) and smoothed within a face only.
CrownBaked bake_crown_faces(const Prototype& prototype, const CrownBakedOptions& options);

}  // namespace understory
