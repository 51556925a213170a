// What the obscurance kernels are told: the camera that saw the depth plane, radii and thickness.
#ifndef UNDERSTORY_OBSCURANCE_SETTING_H
#define UNDERSTORY_OBSCURANCE_SETTING_H

#include "kernels/shared/records.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

/// Axes are unit, world directions; pixel centres at +0.5, y down.
typedef struct {
  float right[4], down[4], forward[4];  // xyz used
  float focal;                          // pixels per unit of x/z; orthographic: pixels per metre
  float centre_x, centre_y;             // principal point, pixels
  float perspective;                    // 1; orthographic: 0
  record_int width, height;             // pixels of the depth plane
  record_int first_x, first_y;          // pixels to add for the pattern of rotations, [0, 3]
  float radius, second_radius;          // m; the second is read with -DRADII only
  float thickness;                      // m, the mean, read with -DTHICKNESS only; of rays: the least
} ObscuranceSetting;                    // 92 bytes

/// A line or point of a sample set, ready for summing.
typedef struct {
  float x, y, z;  // radii from the middle of the ball, z along the view; lines: z is half the line's length
  float share;    // lines: over the whole line's integral of the falloff
} ObscuranceRow;  // 16 bytes

#ifndef __OPENCL_C_VERSION__
static_assert(sizeof(ObscuranceSetting) == 92 && sizeof(ObscuranceRow) == 16);
}  // namespace understory
#endif
#endif
