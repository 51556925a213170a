// What the W fragments of a work-item belong to. A kernel that needs one number per owner takes a column (owner_column);
// one that needs a whole record goes through the distinct owners one by one, and reads each row once for all its lanes:
//   for (truth left = ALL_LANES; ANY(left);) {
//     const uint row = next_owner(owner, left);
//     const truth lanes = left & (owner == (bits)(row));
//     left &= NOT(lanes);
//     ... one row, for `lanes`
//   }
#ifndef UNDERSTORY_OWNER_TABLE_H
#define UNDERSTORY_OWNER_TABLE_H

#include "kernels/shared/real.h"

#define ALL_LANES ((truth)(-1))

/// Row within the table of `owners` rows; a foreign image may name others, which count as the background's.
SHARED bits owner_row(bits owner, uint owners) { return PICK(owner < (bits)(owners), owner, (bits)(0u)); }

/// The largest owner among the lanes that are left.
SHARED uint next_owner(bits owner, truth left) {
  const bits candidates = PICK(left, owner, (bits)(0u));
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
#if W == 1
  return column[owner];
#else
  const uint first = owner.s0;
  if (!ANY(owner != (bits)(first))) return (bits)(column[first]);
  return GATHER(bits, column, owner, );
#endif
}

SHARED whole signed_owner_column(global const int* column, bits owner) {
  return AS_WHOLE(owner_column((global const uint*)column, owner));
}

#endif
