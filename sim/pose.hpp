// Where everything is at time t: limb transforms, crowns, occluder spheres, and the wind that grass sees.
// A pure function of (world, t), evaluated in double; stored as float relative to the camera.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "kernels/shared/records.h"
#include "sim/world.hpp"

namespace understory {

/// A crown at time t: the shell's centre moved with the sway. Camera-relative metres.
struct PosedCrown {
  glm::vec3 sphere_centre{0};
  float sphere_radius = 0;
  glm::vec3 ellipsoid_centre{0};
  glm::mat3 ellipsoid_axes{1};
  glm::vec3 ellipsoid_radii{0};
  std::vector<glm::vec4> shells;                 // clustered spheres: centre, radius
  std::vector<float> shell_opacity;              // of each: share of the sky light its disc blocks
  std::int32_t species = -1;                     // index in World::crown_models
  float shell_scale = 1;                         // CrownModel's
  float scale = 1;                               // of the plant
  float alpha_rho = 0, alpha_rho_ellipsoid = 0;  // eq. 6 in the sphere and in the ellipsoid, 1/m^3
  float alpha_rho_levels = 0;                    // and with the sphere's visibility as a factor
  float alpha_rho_shells = 0;                    // in the nearest clustered sphere
  float reeves_blau_ambient = 1, reeves_blau_extinction = 0;
  float opacity = 1;        // share of the sky light its disc blocks: 1 - mean transmittance
  std::int32_t group = -1;  // Owner::group of the plant
};

/// A sphere standing for (a piece of) a moving occluder. Camera-relative metres.
struct PosedSphere {
  glm::vec3 centre{0};
  float radius = 0;
  std::int32_t group = -1;  // Owner::group of the part: it does not shade itself
};

struct Pose {
  double time = 0;
  glm::dvec3 eye{0};                      // camera position relative to the origin
  std::vector<LimbPose> limbs;            // all instances' limbs, in order of World::instances; or without plants'
  std::vector<std::uint32_t> first_limb;  // per instance
  std::vector<PosedCrown> crowns;         // indexed by Owner::crown
  std::vector<PosedSphere> spheres;       // moving occluders
  std::vector<GrassWind> grass;           // per World::grass
};

/// `eye` is subtracted from every position. Deterministic for any thread count.
Pose pose_at(const World& world, double time, glm::dvec3 eye);

/// The same without the limbs of plants, of which a forest has too many to hold at once.
Pose pose_without_plants(const World& world, double time, glm::dvec3 eye);

/// The limbs that pose_without_plants leaves out, of one plant.
std::vector<LimbPose> plant_limbs_at(const World& world, std::size_t instance, double time, glm::dvec3 eye);

}  // namespace understory
