// What a rigid body blocks of the sky around it, sampled on a grid in its own frame: plain data, and the steps of
// Malmer et al. 2005 ("Fast Precomputed Ambient Occlusion for Proximity Shadows") that need no rays.
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace understory {

/// Samples per axis; the outermost lie on the faces of the box, so that the border can be exactly open.
using GridSize = std::array<std::uint32_t, 3>;

inline constexpr std::uint32_t least_grid_size = 2, largest_grid_size = 512;

/// How occlusion ends at the border. `fade`: the traced values, times a weight that falls to 0 over the outer 1/16 of
/// the box, or from its last sample but one. `rescale`: the paper's section 3.3.2, max(0, (a - M)/(1 - M)) with M the
/// largest value on the faces, which takes M from every value in the box: four times the error
/// (tests/kernels/grid_accuracy_test.cpp).
enum class GridBorder { fade, rescale };

/// Occluded directions at one point: their share of the full sphere, eq. 5, in [0, 1], and their mean direction times
/// that share, (1/4 pi) times the integral of the direction, at most 1/4 long. A receiver of normal n that sees all of
/// them above its plane loses exactly 4 n.direction of V_c.
struct OccludedDirections {
  float share = 0;
  glm::vec3 direction{0};
};

/// Along each axis, u in [-1, 1] across the box, sample i of n stands where 2 i / (n - 1) - 1 = u (1 + stretch) / (1 +
/// stretch |u|): 1 + stretch times as dense in the middle as even spacing, that much sparser at the faces. Far from a
/// body occlusion is smooth and falls with the square of distance, so few samples serve; near it every one is wanted.
struct OcclusionGrid {
  GridSize size{0, 0, 0};
  glm::vec3 low{0}, high{0};         // the box, m, frame of the body
  float border = 0;                  // M of the rescale, or 0: share before it = share (1 - border) + border
  std::vector<float> share;          // x fastest, then y, then z; 1: within the solid, as are all neighbours
  std::vector<glm::vec3> direction;  // the same order; empty in a scalar grid
  float stretch = 0;                 // how samples crowd about the middle, see below; 0: evenly spread
  std::size_t samples() const { return std::size_t(size[0]) * size[1] * size[2]; }
  bool has_direction() const { return !direction.empty(); }
  glm::vec3 position(std::uint32_t x, std::uint32_t y, std::uint32_t z) const;
};

/// Trilinear, in the frame of the body; nothing is blocked outside the box. `direction` is 0 in a scalar grid.
OccludedDirections occluded_at(const OcclusionGrid& grid, glm::dvec3 position);

struct Box {
  glm::dvec3 low{0}, high{0};
};

/// Eq. 4 about the body's bounding box: half-extents e_i = r_i + sqrt(A_i / (4 pi epsilon)), A_i the area of the box's
/// face across axis i, but at least 1/16 of the largest one: else a flat body would reach the border within its plane.
Box grid_extent(const Box& body, double epsilon);

/// Section 3.3.3: samples whose share is 1 (every ray blocked) take the mean of those of their 26 neighbours that
/// are not, layer by layer until none is left. A grid that is blocked everywhere stays as it is.
void fill_inside(OcclusionGrid& grid);

/// Gives the share 1 and no direction to samples that lie within the solid (`inside` not 0, one a sample) with all 26
/// neighbours: all of a cell that has such a corner lies within it, so that no receiver outside is told anything else,
/// and whoever looks up such a cell knows that it is no place for a receiver. Before the border is opened.
void close_solid(OcclusionGrid& grid, std::span<const std::uint8_t> inside);

/// |u| from which `fade` acts: 7/8, or the last sample but one along some axis.
float faded_from(const OcclusionGrid& grid);

/// Makes the border open.
void open_border(OcclusionGrid& grid, GridBorder how);

/// 8-bit storage: share as unorm8 (32 KiB at 32^3), or four bytes a sample (128 KiB): 4 direction as snorm8 + 128, then
/// the share as unorm8. Off by at most 1/510 of the share and 1/1016 of each component of the direction; 255 stands for
/// a share of 1 alone, so that shares from 0.998 on are off by 1/255.
std::vector<std::uint8_t> packed_share(const OcclusionGrid& grid);
std::vector<std::uint8_t> packed_cone(const OcclusionGrid& grid);

/// The grid as its packed form says.
OcclusionGrid unpacked(const OcclusionGrid& shape, std::span<const std::uint8_t> bytes);

}  // namespace understory
