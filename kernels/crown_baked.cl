// Visibility of a plant's surfaces as traced on the plant at rest (shared/crown_baked.h): one texel per fragment.
// Fragments without a texel get 1. One work-item per W fragments; planes are padded (host/passes/planes.hpp).
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/crown_baked.h"
#include "kernels/shared/fetch_ahead.h"

#define CORNER(number) TO_REAL(AS_WHOLE((corners >> (8 * (number))) & (bits)(255u)))
#define FRACTION(bits_of_it) (TO_REAL(AS_WHOLE((bits_of_it) & (bits)(4095u))) * (real)(1.0f / TEXEL_FRACTIONS))
#define TILT(place) (TO_REAL(AS_WHOLE((place) >> 24)) * (real)(1.0f / TILT_STEPS))

// Texels of a work-item to come: neighbours mostly see the same leaf, every fourth fragment stands for them.
static inline void fetch_texels(global const uint* texel, global const uint* texels, uint texel_count, uint i,
                                uint items) {
#if W > 1
  const size_t first = (size_t)min(i + 256 / W, items - 1) * W;
  for (uint lane = 0; lane < W; lane += 4) fetch_ahead(texels + min(texel[first + lane], texel_count));
#endif
}

kernel void shade_crown_baked(global const uint* texel, global const uint* texel_place, global const uint* texels,
                              uint texel_count, uint items, global float* visibility) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  fetch_plane(texel, i);
  fetch_plane(texel_place, i);
  fetch_texels(texel, texels, texel_count, i, items);
  const bits at = LOAD(texel, i);
  const truth known = at < (bits)(texel_count);
  const bits number = PICK(known, at, (bits)(0u));
  const bits corners = GATHER(bits, texels, number, );
  const bits place = LOAD(texel_place, i);
  const real v = texel_visibility(CORNER(0), CORNER(1), CORNER(2), CORNER(3), FRACTION(place), FRACTION(place >> 12),
                                  TILT(place));
  STORE(PICK(known, v, REAL(1.0)), visibility, i);
}
