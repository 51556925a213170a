// From a work-item to its fragments' obscurance: what lines and points share. OpenCL only.
#ifndef UNDERSTORY_OBSCURANCE_ENTRY_H
#define UNDERSTORY_OBSCURANCE_ENTRY_H

#include "kernels/shared/obscurance_fragments.h"

/// Each kernel's own: the open share of the ball of `radius` metres.
SHARED real ball_obscurance(global const float* depth, global uint* validity, global const ObscuranceRow* rows,
                            uint count, uint item, Pixels at, Receiver to, truth drawn, float radius,
                            const ObscuranceSetting* setting);

/// 1 on the background.
SHARED void shade_balls(global const float* depth, global const float* normal_x, global const float* normal_y,
                        global const float* normal_z, const ObscuranceSetting* setting,
                        global const ObscuranceRow* rows, uint count, uint items, global float* visibility,
                        global uint* validity) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  const truth drawn = drawn_lanes(validity, i);
  if (!ANY(drawn)) {
    STORE(REAL(1.0), visibility, i);
    return;
  }
  const Pixels at = pixels_of(i, setting);
  const Receiver to = receiver_of(at, LOAD(depth, i), LOAD(normal_x, i), LOAD(normal_y, i), LOAD(normal_z, i), setting);
  real v = ball_obscurance(depth, validity, rows, count, i, at, to, drawn, setting->radius, setting);
#ifdef RADII
  const real second = ball_obscurance(depth, validity, rows, count, i, at, to, drawn, setting->second_radius, setting);
  v = RADII == 1 ? v * second : at_most(v, second);
#endif
  STORE(PICK(drawn, v, REAL(1.0)), visibility, i);
}

#endif
