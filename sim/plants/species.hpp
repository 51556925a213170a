// A species made ready to stand in a scene: its shape at rest, how it sways, and the constants of its crown models.
#pragma once
#include <cstdint>
#include <string>

#include "sim/prototype.hpp"
#include "sim/scene.hpp"

namespace understory {

/// How the pieces of a plant answer the wind, at the plant's own height.
struct SpeciesTraits {
  SwayMode trunk, branch, leaf;
};

struct Species {
  Prototype prototype;
  SwayMode trunk, branch, leaf;
  float alpha_rho = 0;               // eq. 6 of Hegeman et al. 2006 in the crown's sphere, 1/m^3
  float alpha_rho_ellipsoid = 0;     // the same in the crown's ellipsoid, 1/m^3
  float alpha_rho_shells = 0;        // the same in the nearest of its clustered spheres, 1/m^3
  float extinction = 0;              // k of the crown's ellipsoid, 1/m
  float reeves_blau_extinction = 0;  // a of exp(-a depth), 1/m
  float opacity = 0;                 // 1 - mean transmittance of the crown's disc
};

/// Builds a species. `mesh` (z up, metres, classes assigned; sim/files/mesh.hpp) is non-null iff `source.mesh` is set.
/// `source.height` > 0 scales the whole plant, leaves included; `source.leaves` > 0 sets their number, and their size
/// follows so that the leaf area stays. Throws Error(invalid_input) for an unknown generator, or a mesh without faces
/// or height.
Species build_species(const SpeciesSource& source, std::uint64_t seed, const RawMesh* mesh);

/// An occluder or terrain: one rigid limb for each part name of `mesh` (in order of first appearance), or one for all.
/// Surface classes as given. Throws Error(invalid_input) when there is no triangle.
Prototype rigid_prototype(const std::string& name, const RawMesh& mesh, bool limb_per_part = true);

}  // namespace understory
