// Which of W lanes are true, as bits of one number: a loop over these visits the true ones only, where a loop over all
// lanes would branch at each.
//   for (uint left = lane_bits(lanes); left != 0;) { const uint lane = next_lane(&left); ... }
#ifndef UNDERSTORY_LANE_BITS_H
#define UNDERSTORY_LANE_BITS_H

#include "kernels/shared/real.h"

#if W == 1
#define LANE_NUMBERS 0
#elif W == 4
#define LANE_NUMBERS ((int4)(0, 1, 2, 3))
#elif W == 8
#define LANE_NUMBERS ((int8)(0, 1, 2, 3, 4, 5, 6, 7))
#else
#define LANE_NUMBERS ((int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15))
#endif

static inline uint lane_bits(truth lanes) {
  const whole bit = PICK(lanes, (whole)(1) << LANE_NUMBERS, (whole)(0));
#if W == 1
  return (uint)bit;
#else
#if W == 16
  const int8 eight = bit.lo | bit.hi;
  const int4 four = eight.lo | eight.hi;
#elif W == 8
  const int4 four = bit.lo | bit.hi;
#else
  const int4 four = bit;
#endif
  const int2 two = four.lo | four.hi;
  return (uint)(two.x | two.y);
#endif
}

// Takes the lowest bit from `*left`, which is not 0; the number of its lane.
static inline uint next_lane(uint* left) {
  const uint lane = 31u - clz(*left & (0u - *left));
  *left &= *left - 1u;
  return lane;
}

#endif
