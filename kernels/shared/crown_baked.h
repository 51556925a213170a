// Visibility kept on the faces of a plant at rest, and how it is looked up. Each triangle a, b, c has on either side a
// grid of columns x rows texels over its shares u of b and v of c; a texel holds V at its four corners, interpolated
// bilinearly. Baked by host/trace/crown_baked.cpp.
#ifndef UNDERSTORY_CROWN_BAKED_H
#define UNDERSTORY_CROWN_BAKED_H

#include "kernels/shared/limits.h"

/// Of a face: x is the first texel of its front, the back's follow; y is columns | rows << 8; 0: not baked.
#define FACE_COLUMNS(face) ((face).y & 255u)
#define FACE_ROWS(face) ((face).y >> 8)

/// A texel is four bytes, corner (0, 0) in the lowest, then (1, 0), (0, 1), (1, 1). V = byte * TEXEL_STEP +
/// TEXEL_LOWEST: beyond [0, 1], because corners may lie outside their triangle. Rounding is at most 0.004.
#define TEXEL_STEP 0.0078431373f
#define TEXEL_LOWEST -0.5f
#define NO_TEXEL 0xffffffffu

/// Where a fragment is in its texel: two fractions of 16 bits, u in the lower.
#define TEXEL_FRACTIONS 65535.0f

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

/// V from a texel's corners as bytes; (u, v) in [0, 1].
SHARED real texel_visibility(real at_00, real at_10, real at_01, real at_11, real u, real v) {
  const real low = fma(u, at_10 - at_00, at_00), high = fma(u, at_11 - at_01, at_01);
  return as_visibility(fma(fma(v, high - low, low), (real)(TEXEL_STEP), (real)(TEXEL_LOWEST)));
}

#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
