// How 16 spheres at a time relate to a tile: which of them are distant, and what folding each one into the tile's far
// occlusion would cost in accuracy. -DSHARE as in solid_angle.cl.
#ifndef UNDERSTORY_TILE_SPHERES_H
#define UNDERSTORY_TILE_SPHERES_H

#include "kernels/shared/far_sphere.h"
#include "kernels/shared/fragment_tiles.h"
#include "kernels/shared/owner_table.h"
#include "kernels/shared/records.h"
#include "kernels/shared/shading_sphere.h"
#include "kernels/shared/solid_angle.h"
#include "kernels/shared/tile_bounds.h"
#include "kernels/shared/tile_occlusion.h"
#include "kernels/shared/validity.h"

#define FAR JOIN(SHARE, _far)

typedef struct {
  real x, y, z, radius, opacity;
  whole group;
  truth there;  // within the list, and shades (shading_sphere.h)
} SphereLanes;

typedef struct {
  truth own;      // of a group that the tile has a fragment of, up to the group's number mod 32
  truth distant;  // at least 4 radii from all fragments, and not own
  truth close;    // at least 1.5 radii, and neither
  truth near;     // all others
  real error;     // of folding, as a change of V
} SphereBounds;

/// Far occlusion so far, one share per lane (tile_occlusion.h), and what it costs.
typedef struct {
  real level, x, y, z, xx, yy, zz, xy, xz, yz;
  float error;
} FarField;

/// Spheres listed so far.
typedef struct {
  uint distant, close, near, own;
} SphereLists;

SHARED FarField no_field(void) {
  const real zero = REAL(0.0);
  const FarField field = {zero, zero, zero, zero, zero, zero, zero, zero, zero, zero, 0.0f};
  return field;
}

SHARED SphereLanes load_spheres(global const ShadingSphere* spheres, uint first, uint count) {
  const bits lane = (bits)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15) + (bits)(first);
  const bits row = min(lane, (bits)(count - 1u));
  SphereLanes s;
  s.x = GATHER(real, spheres, row, .x);
  s.y = GATHER(real, spheres, row, .y);
  s.z = GATHER(real, spheres, row, .z);
  s.radius = GATHER(real, spheres, row, .radius);
  s.opacity = at_most(GATHER(real, spheres, row, .opacity), REAL(1.0));
  s.group = GATHER(whole, spheres, row, .group);
  s.there = (lane < (bits)(count)) & (s.radius > (real)(SMALLEST)) & (s.radius < (real)(FARTHEST)) &
            (s.opacity > REAL(0.0)) & in_reach(s.x, s.y, s.z);
  return s;
}

/// Distance along one axis from the box to the sphere's centre.
SHARED real off_axis(const TileView view, int axis, real centre) {
  return fmax(fmax(centre - (real)(view.high[axis]), (real)(view.low[axis]) - centre), REAL(0.0));
}

SHARED SphereBounds bound_spheres(const TileView view, const SphereLanes s) {
  const real dx = off_axis(view, 0, s.x), dy = off_axis(view, 1, s.y), dz = off_axis(view, 2, s.z);
  const real distance = sqrt(distance_squared(dx, dy, dz));  // of the nearest point of the box
  const real inverse = REAL(1.0) / at_least(distance, REAL(1e-6));
  const real ratio = at_most(s.radius * inverse, REAL(1.0)), q = ratio * ratio;

  SphereBounds bounds;
  const bits bit = (bits)(1u) << (TO_BITS(s.group) & (bits)(31u));
  bounds.own = s.there & (s.group >= 0) & ((bit & (bits)(view.groups)) != (bits)(0u));
  bounds.distant = s.there & NOT(bounds.own) & (ratio <= REAL(0.25));
  bounds.close = s.there & NOT(bounds.own) & (ratio > REAL(0.25)) & (ratio <= REAL(0.66666667));
  bounds.near = s.there & NOT(bounds.distant | bounds.close);
  real units = fma((real)(FAR.moved * view.reach), inverse, (real)(FAR.error));
  units = fma((real)(FAR.root_error), ratio, units);
  // exp(-e) is folded in place of 1 - e: off by e^2/2, and e is 17/16 of the share at most.
  bounds.error = s.opacity * q * fma(REAL(0.57) * s.opacity, q, units);
  return bounds;
}

SHARED float total(real v) {
  const float8 a = v.lo + v.hi;
  const float4 b = a.lo + a.hi;
  return (b.x + b.y) + (b.z + b.w);
}

/// Sum of the lanes up to each lane.
SHARED real running_total(real v) {
  const float none = 0.0f;
  v += (real)(none, v.s0, v.s1, v.s2, v.s3, v.s4, v.s5, v.s6, v.s7, v.s8, v.s9, v.sa, v.sb, v.sc, v.sd, v.se);
  v += (real)(none, none, v.s0, v.s1, v.s2, v.s3, v.s4, v.s5, v.s6, v.s7, v.s8, v.s9, v.sa, v.sb, v.sc, v.sd);
  v += (real)((float4)(none), v.s0123, v.s4567, v.s89ab);
  return v + (real)((float8)(none), v.lo);
}

/// Spheres worth folding, from the first one on while the budget lasts.
SHARED truth choose_folded(const SphereBounds bounds, float each, float budget, private FarField* field) {
  const truth cheap = bounds.distant & (bounds.error <= (real)(each));
  const real error = PICK(cheap, bounds.error, REAL(0.0));
  const truth folded = cheap & (running_total(error) <= (real)(budget - field->error));
  field->error += total(PICK(folded, error, REAL(0.0)));
  return folded;
}

SHARED void fold(const TileView view, const SphereLanes s, truth folded, private FarField* field) {
  const real dx = s.x - (real)(view.middle[0]), dy = s.y - (real)(view.middle[1]), dz = s.z - (real)(view.middle[2]);
  const real inverse = REAL(1.0) / sqrt(at_least(distance_squared(dx, dy, dz), REAL(1e-12)));
  const real ux = dx * inverse, uy = dy * inverse, uz = dz * inverse, ratio = s.radius * inverse;
  const real weight = PICK(folded, s.opacity * ratio * ratio, REAL(0.0));
  const real c1 = weight * (real)(FAR.c1), c2 = weight * (real)(FAR.c2);
  field->level = fma(weight, (real)(FAR.c0), field->level);
  field->x = fma(c1, ux, field->x);
  field->y = fma(c1, uy, field->y);
  field->z = fma(c1, uz, field->z);
  field->xx = fma(c2 * ux, ux, field->xx);
  field->yy = fma(c2 * uy, uy, field->yy);
  field->zz = fma(c2 * uz, uz, field->zz);
  field->xy = fma(REAL(2.0) * c2 * ux, uy, field->xy);
  field->xz = fma(REAL(2.0) * c2 * ux, uz, field->xz);
  field->yz = fma(REAL(2.0) * c2 * uy, uz, field->yz);
}

/// Appends `first` + lane and 1/radius for each lane that `counts`; what does not count is written over by the next that
/// does.
SHARED uint append(global uint2* list, uint length, uint first, real radius, truth counts) {
  int steps[W];
  uint scales[W];
  STORE(counts & 1, steps, 0);
  STORE(JOIN(as_uint, W)(REAL(1.0) / radius), scales, 0);
  for (uint lane = 0; lane < W; ++lane) {
    list[length] = (uint2)(first + lane, scales[lane]);
    length += steps[lane];
  }
  return length;
}

SHARED TileOcclusion tile_occlusion(const FarField field, const SphereLists lists) {
  const TileOcclusion tile = {total(field.level), total(field.x),  total(field.y),  total(field.z),
                              total(field.xx),    total(field.yy), total(field.zz), total(field.xy),
                              total(field.xz),    total(field.yz), lists.distant,   lists.close,
                              lists.near,         lists.own,       field.error,     {0}};
  return tile;
}

#endif
