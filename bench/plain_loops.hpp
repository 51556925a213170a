// Methods as one would write them in C++ alone: a loop over fragments, compiled for this very processor. What the
// kernels have to be worth their trouble against.
#pragma once
#include <cstddef>
#include <cstdint>

#include "kernels/shared/records.h"

namespace understory {

/// Planes in host memory, as host/passes/planes.hpp.
struct PlainFragments {
  const float *position_x = nullptr, *position_y = nullptr, *position_z = nullptr;
  const float *normal_x = nullptr, *normal_y = nullptr, *normal_z = nullptr;
  const float *height = nullptr, *blade_length = nullptr;
  const std::uint32_t* owner = nullptr;
};

/// `owner_crown`: per owner its row of `crowns`; -1: none, V = 1. Fragments [begin, end).
void plain_sphere_cap(const PlainFragments& fragments, const std::int32_t* owner_crown, const CrownRecord* crowns,
                      float* visibility, std::size_t begin, std::size_t end);

/// `owner_class`: per owner; others than `blade_class`: V = 1.
void plain_grass_height(const PlainFragments& fragments, const std::uint32_t* owner_class, std::uint32_t blade_class,
                        float* visibility, std::size_t begin, std::size_t end);

}  // namespace understory
