// Which of W lanes are true, as bits of one number: a loop over these visits the true ones only, where a loop over all
// lanes would branch at each.
//   for (uint left = lane_bits(lanes); left != 0;) { const uint lane = next_lane(&left); ... }
#ifndef UNDERSTORY_LANE_BITS_H
#define UNDERSTORY_LANE_BITS_H

#include "kernels/shared/real.h"

static inline uint lane_bits(truth lanes) {
#if W == 1
  return (uint)(lanes != 0);
#elif defined(LANE_MASK)
  return LANE_MASK(lanes);
#else
  return (uint)or_lanes(PICK(lanes, (whole)(1) << LANE_NUMBERS, (whole)(0)));
#endif
}

// Takes the lowest bit from `*left`, which is not 0; the number of its lane.
static inline uint next_lane(uint* left) {
  const uint lane = 31u - clz(*left & (0u - *left));
  *left &= *left - 1u;
  return lane;
}

#endif
