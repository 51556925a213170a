// Bounds of the positions of a tile's fragments, gathered 16 lanes at a time, then put together.
#ifndef UNDERSTORY_TILE_BOUNDS_H
#define UNDERSTORY_TILE_BOUNDS_H

#include "kernels/shared/limits.h"

typedef struct {
  real low, high;  // per lane; low > high: nothing yet
} Range;

typedef struct {
  Range x, y, z;  // positions, m
  bits groups;    // bit g mod 32 for every owner group g >= 0
} TileBounds;

/// The tile as spheres see it.
typedef struct {
  float low[3], high[3], middle[3];  // m, camera-relative
  float reach;                       // m: largest distance of a fragment from the middle
  uint groups;
  int drawn;                         // it has fragments at all
} TileView;

SHARED TileBounds no_bounds(void) {
  const Range none = {(real)(INFINITY), (real)(-INFINITY)};
  const TileBounds bounds = {none, none, none, (bits)(0u)};
  return bounds;
}

SHARED void include(private Range* range, real value, truth drawn) {
  range->low = PICK(drawn & (value < range->low), value, range->low);
  range->high = PICK(drawn & (value > range->high), value, range->high);
}

SHARED bits groups_of(whole group, truth drawn) {
  return PICK(drawn & (group >= 0), (bits)(1u) << (TO_BITS(group) & (bits)(31u)), (bits)(0u));
}

SHARED float lowest(real v) {
  const float8 a = fmin(v.lo, v.hi);
  const float4 b = fmin(a.lo, a.hi);
  return fmin(fmin(b.x, b.y), fmin(b.z, b.w));
}

SHARED float highest(real v) { return -lowest(-v); }

SHARED uint any_bits(bits v) {
  const uint8 a = v.lo | v.hi;
  const uint4 b = a.lo | a.hi;
  return b.x | b.y | b.z | b.w;
}

SHARED TileView view_of(const TileBounds bounds) {
  TileView view;
  const Range position[3] = {bounds.x, bounds.y, bounds.z};
  float reach = 0;
  for (int axis = 0; axis < 3; ++axis) {
    view.low[axis] = lowest(position[axis].low);
    view.high[axis] = highest(position[axis].high);
    view.middle[axis] = 0.5f * (view.low[axis] + view.high[axis]);
    const float edge = 0.5f * (view.high[axis] - view.low[axis]);
    reach += edge * edge;
  }
  view.reach = sqrt(reach);
  view.groups = any_bits(bounds.groups);
  view.drawn = view.low[0] <= view.high[0];
  return view;
}

#endif
