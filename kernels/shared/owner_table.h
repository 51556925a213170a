// What the W fragments of a work-item belong to. Neighbours mostly share an owner, so a column of the owner table costs
// one look-up for all of them, or one for each. Where a whole record is wanted, kernels read it once for ONE_OWNER, else
// go through the distinct rows one by one and read each of them once for all of its lanes:
//   for (truth left = ALL_LANES; ANY(left);) {
//     const uint row = next_owner(rows, left);
//     const truth lanes = left & (rows == (bits)(row));
//     left &= NOT(lanes);
//     ... one record, for `lanes`
//   }
#ifndef UNDERSTORY_OWNER_TABLE_H
#define UNDERSTORY_OWNER_TABLE_H

#include "kernels/shared/real.h"

#define ALL_LANES ((truth)(-1))

/// Whether all lanes hold one owner; it is FIRST_LANE.
#if W == 1
#define ONE_OWNER(rows) 1
#define FIRST_LANE(rows) (rows)
#else
#define ONE_OWNER(rows) (!ANY((rows) != (bits)((rows).s0)))
#define FIRST_LANE(rows) ((rows).s0)
#endif

/// Row within the table of `owners` rows; a foreign image may name others, which count as the background's.
SHARED bits owner_row(bits owner, uint owners) { return PICK(owner < (bits)(owners), owner, (bits)(0u)); }

/// The largest row among the lanes that are left.
SHARED uint next_owner(bits rows, truth left) {
  const bits candidates = PICK(left, rows, (bits)(0u));
#if W == 1
  return candidates;
#elif W == 4
  const uint2 two = max(candidates.lo, candidates.hi);
  return max(two.x, two.y);
#else
#if W == 16
  const uint8 eight = max(candidates.lo, candidates.hi);
#else
  const uint8 eight = candidates;
#endif
  const uint4 four = max(eight.lo, eight.hi);
  const uint2 two = max(four.lo, four.hi);
  return max(two.x, two.y);
#endif
}

/// The column's value for each lane: one look-up where all lanes share an owner, else one per lane.
SHARED bits owner_column(global const uint* column, bits owner) {
  if (ONE_OWNER(owner)) return (bits)(column[FIRST_LANE(owner)]);
  return GATHER(bits, column, owner, );
}

SHARED whole signed_owner_column(global const int* column, bits owner) {
  return AS_WHOLE(owner_column((global const uint*)column, owner));
}

#endif
