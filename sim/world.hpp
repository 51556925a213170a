// The scene made concrete: every plant placed, every blade rooted, every prototype built. Independent of time.
// A function of (scene, seed) alone: the same on every machine, device and thread count.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "sim/environment.hpp"
#include "sim/prototype.hpp"
#include "sim/scene.hpp"

namespace understory {

class Terrain;    // sim/terrain.hpp
class Wind;       // sim/wind.hpp
struct Dynamics;  // sim/dynamics.hpp

/// One row of the owner table: what a fragment belongs to. Row 0 is the background.
struct Owner {
  SurfaceClass surface = SurfaceClass::background;
  std::string species;         // species, grass field, or occluder name
  std::int32_t instance = -1;  // index in World::instances (or World::grass for blades)
  glm::vec3 albedo{0};
  std::int32_t crown = -1;  // index in Pose::crowns of the crown that it is part of; -1: none
  std::int32_t group = -1;  // bodies that do not shade themselves by their own sphere share a group
};

/// A prototype placed in the scene: a plant (pose from the wind), an occluder (pose from its path), or the terrain.
struct Instance {
  std::uint32_t prototype = 0;
  enum class Role : std::uint8_t { terrain, plant, occluder } role = Role::plant;
  std::int32_t species = -1;   // index in Scene::species; plants only
  std::int32_t occluder = -1;  // index in Scene::occluders; occluders only
  glm::dvec3 position{0};      // root, relative to the origin
  double yaw = 0, scale = 1;
  double delay = 0;                      // s, individual shift of its sway
  std::int32_t crown = -1;               // index in Pose::crowns; plants with foliage only
  std::vector<std::uint32_t> run_owner;  // owner of each TriangleRun of the prototype
};

/// Blades of one grass field. Structure of arrays, one entry a blade.
struct GrassBlades {
  std::uint32_t field = 0;  // index in Scene::grass
  std::uint32_t owner = 0;
  std::vector<float> root_x, root_y, root_z;  // m, relative to the origin
  std::vector<float> length, half_width;      // m
  std::vector<float> bend_x, bend_y;          // rest bend: tip angle times its horizontal direction, radians
  std::vector<float> facing;                  // azimuth of the blade's width, radians
  std::vector<float> flexibility;             // 1 / relative stiffness
  std::vector<float> phase;                   // radians, of its own flutter
  std::size_t size() const { return length.size(); }
};

/// Constants of the crown models of one species at scale 1. A plant of scale s has alpha_rho / s^3 and extinction / s.
struct CrownModel {
  float alpha_rho = 0, alpha_rho_ellipsoid = 0;               // eq. 6 in the crown's sphere and ellipsoid, 1/m^3
  float alpha_rho_shells = 0;                                 // in the nearest of the clustered spheres, 1/m^3
  float alpha_rho_levels = 0;                                 // with the whole sphere's visibility as a factor
  CrownShape shape = CrownShape::ellipsoid;                   // that crown-transmittance takes
  float extinction = 0;                                       // its k, 1/m
  float shell_scale = 1;                                      // times the shell that holds all foliage: sparse rims
  float near_share = 1;                                       // its share that leaves next to a fragment let through
  float reeves_blau_ambient = 1, reeves_blau_extinction = 0;  // A; a, 1/m
  float opacity = 0;                                          // 1 - mean transmittance of the crown's disc
  std::vector<float> shell_opacity;                           // the same of each clustered sphere
};

/// A sphere that stands for (a piece of) an occluder part in the solid-angle methods.
struct OccluderSphere {
  std::uint32_t instance = 0, limb = 0;  // limb of the instance's prototype
  glm::vec3 centre{0};                   // m, prototype frame
  float radius = 0;                      // m
  std::int32_t group = -1;               // Owner::group of the part
};

/// A grid of the mean visibility of the ground under grass, 2 E3(LAI/2) (FORMULAS.md, analytic truths): 1 on bare
/// ground. A value belongs to its cell's centre; the outermost ring of cells is bare, so that a look-up may clamp to
/// the edge.
struct GroundCover {
  Region extent;
  std::uint32_t columns = 0, rows = 0;  // 0: no grass
  std::vector<float> visibility;        // row-major, y up
};

struct World {
  Scene scene;
  std::vector<Prototype> prototypes;
  std::vector<Instance> instances;
  std::vector<GrassBlades> grass;
  std::vector<Owner> owners;
  GroundCover ground_cover;
  std::vector<CrownModel> crown_models;  // per Scene::species
  std::vector<OccluderSphere> occluder_spheres;
  std::shared_ptr<const Terrain> terrain;  // null: no terrain, plants stand on z = 0
  std::shared_ptr<const Wind> wind;
  std::shared_ptr<const EnvironmentMap> environment;  // null: a uniform sky
  std::shared_ptr<const Dynamics> dynamics;           // what pose_at looks up: sway series, recorded motion
};

/// Builds everything a scene describes. Throws Error(invalid_input) naming file, key and value.
World build_world(const Scene& scene);

}  // namespace understory
