// A rigid body's occlusion grid at time t: where it is, which samples are its own, and whom it belongs to.
#ifndef UNDERSTORY_GRID_RECORD_H
#define UNDERSTORY_GRID_RECORD_H

#ifdef __OPENCL_C_VERSION__
typedef int grid_int;
typedef uint grid_uint;
#else
#include <cstdint>
namespace understory {
typedef std::int32_t grid_int;
typedef std::uint32_t grid_uint;
#endif

typedef struct {
  float to_box[12];                 // 3x4, row-major: camera-relative metres to [-1, 1] along each axis of the box
  float axes[12];                   // 3x3, rows padded to 4: directions of the body's frame to world axes, a rotation
  grid_uint first;                  // its first sample in the table
  grid_uint width, height, depth;   // samples per axis, at least 2
  grid_int group;                   // Owner::group of the part: its fragments are shaded by what rises above their plane
  float border;                     // M of the border's rescale (sim/occlusion_grid.hpp)
  float stretch;                    // >= 0: how samples crowd about the box's middle (sim/occlusion_grid.hpp)
  float faded_from;                 // |u| along an axis of the box from which occlusion has been faded
  grid_uint own_first, own_size;    // its own shadow (sim/own_shadow.hpp): first sample, samples per axis or 0: it has none
  float own_scale[3];               // half-extents of the box by those of the own shadow's
  float padding_[3];
} GridRecord;                       // 160 bytes

#ifndef __OPENCL_C_VERSION__
static_assert(sizeof(GridRecord) == 160);
}  // namespace understory
#endif
#endif
