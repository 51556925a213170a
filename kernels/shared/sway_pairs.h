// Neighbours in a series of (along, across) pairs, looked up at a place of its own for each lane.
#ifndef UNDERSTORY_SWAY_PAIRS_H
#define UNDERSTORY_SWAY_PAIRS_H

#include "kernels/shared/posed_vertices.h"

typedef struct {
  real along, across, next_along, next_across;
} SwayPairs;

static inline SwayPairs gather_pairs(global const float2* series, whole first, whole next) {
  SwayPairs pairs;
#if W == 16
  // Both pairs of a lane make a record of four floats: four loads of 8 bytes a vector and one transposition, where
  // gathering the four members takes four times as many loads.
#define BOTH(lane) series[first.s##lane], series[next.s##lane]
  const float16 r0 = (float16)(BOTH(0), BOTH(4), BOTH(8), BOTH(c)), r1 = (float16)(BOTH(1), BOTH(5), BOTH(9), BOTH(d));
  const float16 r2 = (float16)(BOTH(2), BOTH(6), BOTH(a), BOTH(e)), r3 = (float16)(BOTH(3), BOTH(7), BOTH(b), BOTH(f));
#undef BOTH
  const float16 low_01 = quarters_first(r0, r1), low_23 = quarters_first(r2, r3);
  const float16 high_01 = quarters_last(r0, r1), high_23 = quarters_last(r2, r3);
  pairs.along = halves_first(low_01, low_23);
  pairs.across = halves_last(low_01, low_23);
  pairs.next_along = halves_first(high_01, high_23);
  pairs.next_across = halves_last(high_01, high_23);
#else
  pairs.along = GATHER(real, series, first, .x);
  pairs.across = GATHER(real, series, first, .y);
  pairs.next_along = GATHER(real, series, next, .x);
  pairs.next_across = GATHER(real, series, next, .y);
#endif
  return pairs;
}

#endif
