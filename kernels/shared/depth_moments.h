// Mean and variance of depth over ever larger squares of pixels, as area samples need them (Loos & Sloan 2010 section
// 4.2). What is averaged is linear over any plane in the image: the inverse of camera z, orthographic -z. Each level keeps
// the variance about its own mean: E[z^2] - E[z]^2 would cancel in float.
#ifndef UNDERSTORY_DEPTH_MOMENTS_H
#define UNDERSTORY_DEPTH_MOMENTS_H

#include "kernels/shared/records.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

/// Texel (x, y) of level l stands for the pixels around ((x + 1/2) 2^l, (y + 1/2) 2^l).
typedef struct {
  record_uint first;          // texel in the moment planes
  record_int width, height;   // texels
  float plane_variance;       // pixels^2 along each axis: how far the level spreads a plane's values
} MomentLevel;                // 16 bytes

#ifndef __OPENCL_C_VERSION__
static_assert(sizeof(MomentLevel) == 16);
}  // namespace understory
#endif
#endif
