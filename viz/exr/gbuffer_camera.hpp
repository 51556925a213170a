// Which camera saw a foreign G-buffer, and whether its positions are the world's or that camera's. For gbuffer.cpp.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "viz/exr/gbuffer.hpp"
#include "viz/exr/image.hpp"

namespace understory {

/// As read, before anything is made of it.
struct GbufferPlanes {
  std::array<Plane, 3> position, normal;
  Plane depth, alpha, owner;  // empty when there is none
};

/// Where a camera stands.
glm::dvec3 eye_of(const glm::dmat4& world_to_camera);

/// Header, else option, else solved from the positions where `surface` is not 0: sets camera and field of view of
/// result.frame, tells in result.notes, and moves camera-space planes into the world. Throws Error(invalid_input).
void settle_camera(const ExrHeader& header, const GbufferOptions& options, const std::vector<std::uint8_t>& surface,
                   GbufferPlanes& planes, Gbuffer& result);

}  // namespace understory
