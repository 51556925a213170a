// Visibility kept on the faces of a plant at rest, and how it is looked up. Each triangle a, b, c has on either side a
// grid of columns x rows texels over its shares u of b and v of c; a texel holds V at its four corners, interpolated
// bilinearly. Baked by host/trace/crown_baked.cpp.
#ifndef UNDERSTORY_CROWN_BAKED_H
#define UNDERSTORY_CROWN_BAKED_H

#include "kernels/shared/limits.h"

/// Of a face: x is the first texel of its front, the back's follow; y is columns | rows << 8 | rise << 16; 0: not baked.
/// The rise is how far the front faced up at rest: n_z = rise / 32767 - 1; NO_RISE: what it sees does not depend on it.
#define FACE_COLUMNS(face) ((face).y & 255u)
#define FACE_ROWS(face) ((face).y >> 8 & 255u)
#define FACE_RISE(face) ((face).y >> 16)
#define RISE_STEPS 32767.0f
#define NO_RISE 0xffffu

/// A texel is four bytes, corner (0, 0) in the lowest, then (1, 0), (0, 1), (1, 1). V = byte * TEXEL_STEP +
/// TEXEL_LOWEST: beyond [0, 1], because corners may lie outside their triangle. Rounding is at most 0.004.
#define TEXEL_STEP 0.0078431373f
#define TEXEL_LOWEST -0.5f
#define NO_TEXEL 0xffffffffu

/// Where a fragment is in its texel, and how its face has tilted: fractions u and v of 12 bits, u the lowest, then the
/// tilt in 8: the open dome's share of the face now over that at rest (open_dome.h), 128 for 1. Leaves that flutter and
/// stems that lean turn towards the sky or away from it, and that is the first thing which wind changes.
#define TEXEL_FRACTIONS 4095.0f
#define TILT_STEPS 128.0f

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

/// V from a texel's corners as bytes; (u, v) in [0, 1], `tilt` in [0, 2].
SHARED real texel_visibility(real at_00, real at_10, real at_01, real at_11, real u, real v, real tilt) {
  const real low = fma(u, at_10 - at_00, at_00), high = fma(u, at_11 - at_01, at_01);
  return as_visibility(fma(fma(v, high - low, low), (real)(TEXEL_STEP), (real)(TEXEL_LOWEST)) * tilt);
}

#ifdef __OPENCL_C_VERSION__
/// The tilt of a face whose seen side faces up by `z` now; `turn`: 1 seen from the front, -1 from behind.
static inline float face_tilt(uint2 face, float z, float turn) {
  const uint rise = FACE_RISE(face);
  const float rest = fma((float)rise, 1.0f / RISE_STEPS, -1.0f);
  const float ratio = (1.0f + z) / fmax(fma(turn, rest, 1.0f), 1e-4f);
  return rise == NO_RISE ? 1.0f : ratio;
}

/// u and v in [0, 1].
static inline uint texel_place_of(float u, float v, float tilt) {
  const uint steps = (uint)fma(fmin(fmax(tilt, 0.0f), 255.0f / TILT_STEPS), TILT_STEPS, 0.5f);
  return (uint)(u * TEXEL_FRACTIONS) | (uint)(v * TEXEL_FRACTIONS) << 12 | steps << 24;
}
#else
}  // namespace understory
#endif
#endif
