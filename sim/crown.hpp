// The crown of a plant: shells of least volume around its foliage, its leaf area, and the constants of the crown
// models that follow from them when a scene gives none.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "sim/prototype.hpp"

namespace understory {

struct Sphere {
  glm::dvec3 centre{0};
  double radius = 0;
};

struct Ellipsoid {
  glm::dvec3 centre{0};
  glm::dmat3 axes{1};   // columns: unit directions, right-handed
  glm::dvec3 radii{0};  // along the columns, falling
};

/// The smallest sphere that holds all points (m). No points: radius 0.
Sphere smallest_sphere(const std::vector<glm::vec3>& points);

/// The ellipsoid of least volume that holds all points (m), to 0.1 % of its volume; a set flatter than 1 % of its
/// diagonal is thickened to that. No points: radii 0.
Ellipsoid smallest_ellipsoid(const std::vector<glm::vec3>& points);

/// The smallest spheres around up to `count` clusters of the points (m): fewer where there are fewer places.
/// Deterministic; clusters of a single place are left out.
std::vector<Sphere> cluster_spheres(const std::vector<glm::vec3>& points, int count);

/// Shells around leaves and blades (wood when there is neither), leaf and plant area; carried by limb 0.
/// `shells`: most spheres of the clustered shell.
CrownShell fit_crown(const Prototype& prototype, int shells = 6);

/// The clustered sphere with the closest centre: it owns the position. There must be one.
std::size_t nearest_shell_of(const CrownShell& crown, const glm::dvec3& position);

/// Constants at scale 1. See crown.cpp for their derivation.
struct CrownConstants {
  double alpha_rho = 0;               // eq. 6 of Hegeman et al. 2006 in the sphere, 1/m^3
  double alpha_rho_ellipsoid = 0;     // the same in the ellipsoid, 1/m^3
  double alpha_rho_shells = 0;        // the same in the nearest of the clustered spheres, 1/m^3
  double reeves_blau_extinction = 0;  // a of A exp(-a depth) in the sphere, 1/m
  double opacity = 0;                 // share of the light that the sphere's disc blocks
  double extinction = 0;              // k of the ellipsoid, 1/m: G PAD with G = 1/2, unclumped
  double mean_visibility = 1;         // of the foliage, V_c under `sky: sphere`: what both models are made to reproduce
};

/// `reeves_blau_ambient`: A, in (0, 1]. All zero without a crown.
CrownConstants derive_constants(const Prototype& prototype, double reeves_blau_ambient = 1);

/// Mean of exp(-k L) over the parallel chords L of a sphere of radius R, of k R = `optical_radius`: 1 at 0, falling.
double disc_transmittance(double optical_radius);

}  // namespace understory
