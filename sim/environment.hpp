// Light from all around: an environment map, and its means over cones and over the sky that a normal faces, as tables
// that kernels look up (Malmer et al. 2005, section 5.3; Pharr and Green 2004, "Ambient Occlusion", GPU Gems).
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "sim/scene.hpp"

namespace understory {

/// Latitude-longitude radiance, linear RGB, row-major from the top. Top row: zenith (+z). The middle column looks along
/// +x, columns to its left look towards +y, as a world background of Blender does.
struct EnvironmentMap {
  int width = 0, height = 0;  // width = 2 height
  std::vector<glm::vec3> radiance;
};

/// Bilinear. `turn`: radians, counter-clockwise seen from above. `direction`: any length but 0.
glm::vec3 radiance_towards(const EnvironmentMap& map, double turn, glm::dvec3 direction);

/// Sizes of the tables. The error that they leave against quadrature is measured by tests/sim/environment_map_test.cpp.
struct PrefilterSize {
  std::uint32_t normal_nodes = 33;  // per side of the square of normals
  std::uint32_t cone_nodes = 33;    // per side of the square of cone axes
  std::uint32_t cone_levels = 25;   // apertures
};

/// Tables over directions: nodes x nodes points of an octahedral map of the sphere, z = 0 on the diamond between the
/// middles of the sides (kernels/shared/environment.h); four floats a node: red, green, blue, 0.
struct PrefilteredEnvironment {
  PrefilterSize size;
  std::vector<float> normals;  // mean radiance of the sky that the normal faces, weighted by the cosine
  std::vector<float> cones;    // mean radiance in a cone about the axis; level l holds the aperture (l/(levels - 1))^2,
                               // as a share of the sphere; at least as wide as the nodes are apart
  glm::vec3 mean{0};           // what an unoccluded horizontal surface sees
};

/// Under `Sky::dome` means are over the part above the horizon; where nothing is above it, over its mirror image, so
/// that a constant map is constant everywhere. The same for any thread count.
PrefilteredEnvironment prefilter(const EnvironmentMap& map, double turn, Sky sky, PrefilterSize size = {});

}  // namespace understory
