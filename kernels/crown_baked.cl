// Visibility of a plant's surfaces as traced on the plant at rest (shared/crown_baked.h): one texel per fragment.
// Fragments without a texel get 1. One work-item per W fragments; planes are padded (host/passes/planes.hpp).
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/crown_baked.h"

#define CORNER(number) TO_REAL(AS_WHOLE((corners >> (8 * (number))) & (bits)(255u)))
#define FRACTION(bits_of_it) (TO_REAL(AS_WHOLE((bits_of_it) & (bits)(4095u))) * (real)(1.0f / TEXEL_FRACTIONS))
#define TILT(place) (TO_REAL(AS_WHOLE((place) >> 24)) * (real)(1.0f / TILT_STEPS))

kernel void shade_crown_baked(global const uint* texel, global const uint* texel_place, global const uint* texels,
                              uint texel_count, uint items, global float* visibility) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  const bits at = LOAD(texel, i);
  const truth known = at < (bits)(texel_count);
  const bits number = PICK(known, at, (bits)(0u));
  const bits corners = GATHER(bits, texels, number, );
  const bits place = LOAD(texel_place, i);
  const real v = texel_visibility(CORNER(0), CORNER(1), CORNER(2), CORNER(3), FRACTION(place), FRACTION(place >> 12),
                                  TILT(place));
  STORE(PICK(known, v, REAL(1.0)), visibility, i);
}
