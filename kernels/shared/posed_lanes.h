// W rest vertices of one limb at time t: they flutter, then the limb carries them (records.h, LimbPose).
// OpenCL only.
#ifndef UNDERSTORY_POSED_LANES_H
#define UNDERSTORY_POSED_LANES_H

#include "kernels/shared/fetch_ahead.h"
#include "kernels/shared/pose_limb.h"
#include "kernels/shared/posed_vertices.h"
#include "kernels/shared/records.h"

// Planes of the rest vertices: direction and phase of their flutter.
typedef struct {
  global const char *x, *y, *z;
  global const uchar* phase;
} RestFlutter;

static inline void fetch_flutter(const RestFlutter* flutter, size_t rest) {
  fetch_bytes(flutter->x, rest);
  fetch_bytes(flutter->y, rest);
  fetch_bytes(flutter->z, rest);
  fetch_bytes(flutter->phase, rest);
}

// `rest`: which W vertices of the planes (x, y, z) come from.
static inline PosedLanes posed_lanes(global const LimbPose* limb, const RestFlutter* flutter, size_t rest, real x,
                                     real y, real z) {
  const real turns = fma(LOAD_BYTE(flutter->phase, rest), REAL(0.00390625), (real)(limb->flutter_phase * 0.15915494f));
  const real swing = (real)(limb->flutter_amplitude) * sine_of_turns(turns);
  x = fma(LOAD_BYTE(flutter->x, rest), swing, x);
  y = fma(LOAD_BYTE(flutter->y, rest), swing, y);
  z = fma(LOAD_BYTE(flutter->z, rest), swing, z);
  pose_on_limb(limb->to_limb, limb->curvature, limb->to_scene, &x, &y, &z);
  const PosedLanes lanes = {x, y, z};
  return lanes;
}

#endif
