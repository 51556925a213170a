// The cones that occlude a fragment, put together one after the other (Malmer et al. 2005 section 5.2). -DCOMBINE=
//   multiply  V = product of 1 - a_i, a_i the cosine-weighted share of each clipped cone
//   simple    1 - A = product of 1 - A_i, axes added weighted by solid angle (section 5.2.1); V from the one cone
//   merge     the union of cones, T_merge (section 5.2.2): what two clipped cones share is counted once
// The running cone lives in private variables: all occluders in one pass, no second buffer.
#ifndef UNDERSTORY_RUNNING_CONE_H
#define UNDERSTORY_RUNNING_CONE_H

#include "kernels/shared/cone.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

/// What has been occluded so far above a fragment's plane. Starts as all 0.
typedef struct {
  real cosine;      // cosine-weighted share of the hemisphere
  real share;       // blocked solid angle
  real aperture;    // solid angle of the cones' union, blocked or not: share / aperture is its opacity
  real x, y, z;     // mean direction, unit, or 0
} RunningCone;

SHARED RunningCone no_cone(void) {
  const real zero = REAL(0.0);
  const RunningCone cone = {zero, zero, zero, zero, zero, zero};
  return cone;
}

/// A cone clipped by the plane of the unit normal (a, b, c). Of a share too small to point anywhere nothing is left.
SHARED RunningCone clip_cone(const Cone cone, real a, real b, real c) {
  const real cosine = at_most(at_least(fma(cone.x, a, fma(cone.y, b, cone.z * c)), REAL(-1.0)), REAL(1.0));
  const real weighted = clip_cosine(cone.aperture, cosine), g = clip_weight(cone.aperture, cosine);
  const real along = fma(-g, cosine, weighted);
  const real x = fma(along, a, g * cone.x), y = fma(along, b, g * cone.y), z = fma(along, c, g * cone.z);
  const real inverse = REAL(1.0) / at_least(sqrt(fma(x, x, fma(y, y, z * z))), REAL(1e-12));
  RunningCone clipped;
  clipped.cosine = cone.opacity * weighted;
  clipped.aperture = clip_solid_angle(cone.aperture, cosine);
  clipped.share = cone.opacity * clipped.aperture;
  clipped.x = x * inverse;
  clipped.y = y * inverse;
  clipped.z = z * inverse;
  return clipped;
}

/// `first` where `condition`, else `second`.
SHARED RunningCone pick_cone(truth condition, const RunningCone first, const RunningCone second) {
  RunningCone cone;
  cone.cosine = PICK(condition, first.cosine, second.cosine);
  cone.share = PICK(condition, first.share, second.share);
  cone.aperture = PICK(condition, first.aperture, second.aperture);
  cone.x = PICK(condition, first.x, second.x);
  cone.y = PICK(condition, first.y, second.y);
  cone.z = PICK(condition, first.z, second.z);
  return cone;
}

/// Mean direction of both, weighted by their shares; unit.
SHARED void add_axes(PRIVATE RunningCone* running, const RunningCone next) {
  const real p = running->share, q = next.share;
  const real x = fma(p, running->x, q * next.x), y = fma(p, running->y, q * next.y), z = fma(p, running->z, q * next.z);
  const real inverse = REAL(1.0) / at_least(sqrt(fma(x, x, fma(y, y, z * z))), REAL(1e-12));
  running->x = x * inverse;
  running->y = y * inverse;
  running->z = z * inverse;
}

SHARED void combine_simple(PRIVATE RunningCone* running, const RunningCone next) {
  add_axes(running, next);
  running->share = fma(REAL(1.0) - running->share, next.share, running->share);
  running->aperture = running->share;
}

/// Its cone is the one of `simple`.
SHARED void combine_multiply(PRIVATE RunningCone* running, const RunningCone next) {
  combine_simple(running, next);
  running->cosine = fma(REAL(1.0) - running->cosine, next.cosine, running->cosine);
}

/// What two cones share geometrically the denser one blocks, and the other hides behind it: the parts of a body do so
/// more than chance has it, and of opaque cones it is the same. Its cosine is the mean of the cones' cosines, the smaller
/// cone's counting more: it is the smaller cone's where that lies within the other.
SHARED void combine_merge(PRIVATE RunningCone* running, const RunningCone next) {
  const real p = at_least(running->share, REAL(1e-9)), q = at_least(next.share, REAL(1e-9));
  const real lean = fma(running->x, next.x, fma(running->y, next.y, running->z * next.z));
  const real overlap = overlap_of_apertures(running->aperture, next.aperture, at_most(at_least(lean, REAL(-1.0)), REAL(1.0)));
  const real twice = overlap * at_most(p / at_least(running->aperture, p), q / at_least(next.aperture, q));
  const real mean = fma(running->cosine * q, q, next.cosine * p * p) / (p * q * (p + q));
  const real common = at_most(twice * mean, at_most(running->cosine, next.cosine));
  add_axes(running, next);
  running->cosine = at_most(running->cosine + next.cosine - at_least(common, REAL(0.0)), REAL(1.0));
  running->share = running->share + next.share - twice;
  running->aperture = running->aperture + next.aperture - overlap;
}

SHARED real visibility_multiply(const RunningCone cone, real a, real b, real c) {
  (void)a, (void)b, (void)c;  // takes what the others take
  return REAL(1.0) - cone.cosine;
}

SHARED real visibility_merge(const RunningCone cone, real a, real b, real c) {
  return visibility_multiply(cone, a, b, c);
}

SHARED real visibility_simple(const RunningCone cone, real a, real b, real c) {
  return REAL(1.0) - clip_cosine(cone.share, fma(cone.x, a, fma(cone.y, b, cone.z * c)));
}

#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
