// The skin of a generated plant: tapered tubes around its stems and folded leaves along its twigs.
#pragma once
#include <cstdint>
#include <vector>

#include "sim/plants/limb_mesh.hpp"
#include "sim/plants/skeleton.hpp"

namespace understory {

/// Trunks, branches on trunks, and the longest of their branches become limbs; a stem that is none belongs to the limb
/// of its parent. Returns the limb of every stem and fills `mesh.limbs`.
std::vector<std::uint32_t> make_limbs(LimbMesh& mesh, const GrowthTraits& traits, const std::vector<Stem>& stems,
                                      std::uint64_t seed);

/// A closed-tip tube around every stem; `limb` is per stem.
void add_wood(LimbMesh& mesh, const GrowthTraits& traits, const std::vector<Stem>& stems,
              const std::vector<std::uint32_t>& limb);

/// `count` leaves of `traits.leaf`, their length multiplied by `size`, evenly along the stems that bear leaves.
/// A leaf is a rhombus of 4 vertices and 2 triangles folded along its midrib.
void add_leaves(LimbMesh& mesh, const GrowthTraits& traits, const std::vector<Stem>& stems,
                const std::vector<std::uint32_t>& limb, int count, double size, std::uint64_t seed);

}  // namespace understory
