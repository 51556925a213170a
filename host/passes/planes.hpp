// The fragments of a frame as planes on the device, and the owner table: what every visibility pass reads.
//
// The one rule of sizes: every plane holds `padded_fragments` elements, `fragments` rounded up to whole blocks of
// `fragment_block`, so that a work-item of any width (W = 1 to 16) and a work-group of any tile has memory of its own.
// Passes compute the padding too; its values mean nothing. Rows of the owner table are clamped in the kernels.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/opencl/buffer.hpp"
#include "sim/world.hpp"

namespace understory {

/// Fragments in a block: the largest tile that a work-group handles, a multiple of every vector width.
inline constexpr std::size_t fragment_block = 256;

constexpr std::size_t padded_fragment_count(std::size_t fragments) {
  return (fragments + fragment_block - 1) / fragment_block * fragment_block;
}

/// One element per fragment, in rows of `row_length` from the top of the image; sizes are `padded_fragments`.
struct FragmentPlanes {
  std::size_t fragments = 0;
  std::size_t padded_fragments = 0;
  std::size_t row_length = 0;                        // image width: neighbours in the image are near in space
  Buffer<float> position_x, position_y, position_z;  // camera-relative m, world axes
  Buffer<float> normal_x, normal_y, normal_z;        // unit, facing the viewer
  Buffer<float> depth;                               // camera z, m
  Buffer<std::uint32_t> owner;                       // row of the owner table; 0: background
  Buffer<std::uint32_t> validity;                    // bit flags of sim/frame.hpp; passes add theirs
  Buffer<float> height_above_root, blade_length;     // m; of grass, else 0; empty when no planned pass reads them
  // Where a mesh fragment and its face normal (turned like `normal`) were at rest; prototype frame, m; else 0. Empty
  // when no planned pass reads them.
  std::array<Buffer<float>, 3> rest_position, rest_normal;
  // Texel of the visible face and the place in it (kernels/shared/crown_baked.h). Empty when no planned pass reads
  // them.
  Buffer<std::uint32_t> texel, texel_place;
};

/// Planes of `width` x `height` fragments, all background. `grass`: with height_above_root and blade_length.
FragmentPlanes allocate_planes(Device& device, std::size_t width, std::size_t height, bool grass);

/// Adds rest_position and rest_normal, all 0.
void allocate_rest_planes(Device& device, FragmentPlanes& planes);

/// Adds texel and texel_place: no fragment has one.
void allocate_texel_planes(Device& device, FragmentPlanes& planes);

/// What each owner is, by row; all of one size. Row 0 is the background.
struct OwnerTables {
  Buffer<std::int32_t> crown;           // row of the crown table; -1: none
  Buffer<std::int32_t> group;           // spheres of the same group do not shade it; -1: none
  Buffer<std::uint32_t> surface_class;  // value of SurfaceClass
  std::uint32_t rows() const { return static_cast<std::uint32_t>(crown.size()); }
};

/// Uploads the columns that passes read. Throws Error(unexpected) for an empty table.
OwnerTables upload_owners(Device& device, std::span<const Owner> owners);

/// Throws Error(unexpected) naming pass, plane and both numbers unless `size` is `expected`.
void require_size(const char* pass, const char* plane, std::size_t size, std::size_t expected);

/// Throws Error(unexpected) naming pass and table when `size` is 0.
void require_some(const char* pass, const char* table, std::size_t size);

/// Requires that the eight planes every visibility pass may read, and `out`, have `padded_fragments` elements.
void require_planes(const char* pass, const FragmentPlanes& planes, const Buffer<float>& out);

/// Number of rows as kernels take it.
template <typename T>
std::uint32_t row_count(const Buffer<T>& table) {
  return static_cast<std::uint32_t>(table.size());
}

}  // namespace understory
