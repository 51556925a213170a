// What a rigid body takes from its own surface, sampled on a grid within its bounding box. A cone of occlusion, looked
// up on the surface itself, mixes what lies before and behind it; here each sample knows of surfaces only.
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace understory {

inline constexpr std::uint32_t own_shadow_size = 32;  // samples per axis

/// Share of V_c that the body itself blocks above a point of its surface, as s + v.n for the normal n there: surfaces
/// that face several ways, a corner or both sides of a wall, can share a sample.
struct OwnShadow {
  std::uint32_t size = 0;      // samples per axis, the outermost on the faces of the box; 0: no ray met the body again
  glm::vec3 low{0}, high{0};   // the box, m, frame of the body; its middle is that of the body's bounding box
  std::vector<glm::vec4> fit;  // v and s, each in [-1, 1]; x fastest, then y, then z
};

/// One point of the surface and what is blocked above it.
struct OwnShadowPoint {
  glm::vec3 position{0}, normal{0};  // m, frame of the body; unit
  float share = 0;                   // of V_c, [0, 1]
};

/// Fits the samples of a box of `size` per axis to points of the surface, each sample to those within a cell of it by
/// their trilinear weights (locally weighted least squares); samples without points take their neighbours' mean.
/// All shares 0, or no points: an OwnShadow of size 0.
OwnShadow fit_own_shadow(std::span<const OwnShadowPoint> points, glm::vec3 low, glm::vec3 high,
                         std::uint32_t size = own_shadow_size);

/// Trilinear; points outside the box count as on its faces. [0, 1].
float own_share(const OwnShadow& shadow, glm::dvec3 position, glm::dvec3 normal);

/// Four bytes a sample: v and s as snorm8 + 128, each off by at most 1/254.
std::vector<std::uint8_t> packed_own_shadow(const OwnShadow& shadow);

/// As its packed form says.
OwnShadow unpacked(const OwnShadow& shape, std::span<const std::uint8_t> bytes);

}  // namespace understory
