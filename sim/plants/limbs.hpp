// Limbs for a plant that comes as a mesh: which pieces of wood sway on their own, and what hangs on which.
#pragma once
#include <cstdint>

#include "sim/plants/limb_mesh.hpp"

namespace understory {

/// Pieces of wood that share positions are one stem. A stem of some extent is a limb, fixed to the nearest larger one
/// (or to the ground: several plants may stand in one mesh); smaller pieces and leaves belong to the limb that is
/// nearest along the wood. A mesh without wood, or of wood in many small pieces, gets a single trunk.
/// `plant`: z up, metres; leaves and blades are told from wood by `surface`. `seed` sets delays and flutter phases.
LimbMesh limbs_from_mesh(const RawMesh& plant, std::uint64_t seed);

}  // namespace understory
