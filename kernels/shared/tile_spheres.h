// How 16 spheres at a time relate to a tile: which of them its fragments can see, and what folding each one into the
// tile's far occlusion would cost in accuracy. -DSHARE as in solid_angle.cl.
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
  truth seen;       // some fragment may lie above some of the sphere
  truth one_normal; // folding with the middle's normal costs less than the quadratic
  real error;       // of folding, as a change of V
} SphereBounds;

/// Far occlusion so far, one share per lane (tile_occlusion.h), and what it costs.
typedef struct {
  real level, x, y, z, xx, yy, zz, xy, xz, yz;
  float error;
} FarField;

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

/// Distance along one axis from the box to the sphere's centre, and the range of the centre's height above tangent planes.
SHARED real bound_axis(const TileView view, int axis, real centre, private Range* height) {
  const real from_high = centre - (real)(view.high[axis]), from_low = centre - (real)(view.low[axis]);
  const real low = (real)(view.normal_low[axis]), high = (real)(view.normal_high[axis]);
  const real p = low * from_high, q = low * from_low, r = high * from_high, s = high * from_low;
  height->low += fmin(fmin(p, q), fmin(r, s));
  height->high += fmax(fmax(p, q), fmax(r, s));
  return fmax(fmax(from_high, -from_low), REAL(0.0));
}

SHARED SphereBounds bound_spheres(const TileView view, const SphereLanes s) {
  Range height = {REAL(0.0), REAL(0.0)};
  const real dx = bound_axis(view, 0, s.x, &height), dy = bound_axis(view, 1, s.y, &height);
  const real dz = bound_axis(view, 2, s.z, &height);
  const real distance = sqrt(fma(dx, dx, fma(dy, dy, dz * dz)));  // of the nearest point of the box
  const real inverse = REAL(1.0) / at_least(distance, REAL(1e-6));
  const real ratio = at_most(s.radius * inverse, REAL(1.0));

  SphereBounds bounds;
  // The paper's share has no tangent plane; its step is 0, as are its slope and its error.
  const truth above = height.high > -s.radius * REAL(1.0001);
  bounds.seen = s.there & (FAR.error > 0.0f ? above : s.there);
  const truth clear = height.low > s.radius;
  const real quadratic = (real)(FAR.error);
  const real one_normal = (real)(FAR.slope * view.spread) + PICK(clear, REAL(0.0), (real)(FAR.step));
  bounds.one_normal = one_normal < quadratic;
  // Within `reach` of the middle the share changes by sqrt(5) q/d at most (of q max(0, n.u)).
  const real moved = (real)(2.2361f * view.reach) * inverse;
  const real units = PICK(bounds.one_normal, one_normal, quadratic) + moved + (real)(FAR.root_error) * ratio;
  bounds.error = s.opacity * ratio * ratio * (units + ratio * ratio);
  return bounds;
}

SHARED float total(real v) {
  const float8 a = v.lo + v.hi;
  const float4 b = a.lo + a.hi;
  return (b.x + b.y) + (b.z + b.w);
}

/// Spheres worth folding, if the budget still has room for them.
SHARED truth choose_folded(const TileView view, const SphereLanes s, const SphereBounds bounds, float each,
                           float budget, private FarField* field) {
  const bits bit = (bits)(1u) << (TO_BITS(s.group) & (bits)(31u));
  const truth own = (s.group >= 0) & ((bit & (bits)(view.groups)) != (bits)(0u));
  const truth cheap = bounds.seen & NOT(own) & (bounds.error <= (real)(each));
  const float all = total(PICK(cheap, bounds.error, REAL(0.0)));
  if (field->error + all > budget) return (truth)(0);
  field->error += all;
  return cheap;
}

SHARED void fold(const TileView view, const SphereLanes s, const SphereBounds bounds, truth folded,
                 private FarField* field) {
  if (!ANY(folded)) return;
  const real dx = s.x - (real)(view.middle[0]), dy = s.y - (real)(view.middle[1]), dz = s.z - (real)(view.middle[2]);
  const real inverse = REAL(1.0) / sqrt(at_least(fma(dx, dx, fma(dy, dy, dz * dz)), REAL(1e-12)));
  const real ux = dx * inverse, uy = dy * inverse, uz = dz * inverse;
  const real ratio = s.radius * inverse;

  const truth flat = folded & bounds.one_normal, quadratic = folded & NOT(bounds.one_normal);
  const real inverse_radius = REAL(1.0) / s.radius;
  const real share = s.opacity * SHARE(dx * inverse_radius, dy * inverse_radius, dz * inverse_radius,
                                       (real)(view.normal[0]), (real)(view.normal[1]), (real)(view.normal[2]));
  // -log(1 - share), share <= 1/2 wherever folding is cheap enough.
  const real depth = share * fma(share, fma(share, REAL(0.33333333), REAL(0.5)), REAL(1.0));
  const real weight = PICK(quadratic, s.opacity * ratio * ratio, REAL(0.0));
  const real c1 = weight * (real)(FAR.c1), c2 = weight * (real)(FAR.c2);
  field->level += fma(weight, (real)(FAR.c0), PICK(flat, depth, REAL(0.0)));
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

SHARED TileOcclusion tile_occlusion(const FarField field, uint groups, uint listed) {
  const TileOcclusion tile = {total(field.level), total(field.x),  total(field.y),  total(field.z),
                              total(field.xx),    total(field.yy), total(field.zz), total(field.xy),
                              total(field.xz),    total(field.yz), listed,          field.error,
                              groups,             {0, 0, 0}};
  return tile;
}

#endif
