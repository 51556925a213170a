// How much a pixel nearby says about a fragment's own surface: for blurs and upsampling that stop at edges. OpenCL only.
#ifndef UNDERSTORY_SURFACE_WEIGHT_H
#define UNDERSTORY_SURFACE_WEIGHT_H

#include "kernels/shared/limits.h"

/// The tangent plane of a fragment in the image: camera z `depth` at the fragment, `slope_x` and `slope_y` of the
/// inverse of that z per pixel (orthographic: of -z), which is linear over a plane.
typedef struct {
  real depth, facing;       // facing: normal times ray, negative
  real across_x, across_y;  // normal times the ray's change per pixel
  real scale;               // m across at the fragment's depth per unit of x/z; orthographic: 1
  real perspective;
} TangentPlane;

/// Height over the plane, m, of what is seen (x, y) pixels away at camera z `depth`.
SHARED real height_over(TangentPlane plane, real x, real y, real depth) {
  const real rise = fma(plane.across_x, x, plane.across_y * y);
  return fma(depth - plane.depth, fma(plane.perspective, rise, plane.facing), plane.scale * rise);
}

/// 1 on the plane with the same normal, 0 from `reach` metres over it and for normals at a right angle.
SHARED real surface_weight(real height, real per_reach, real cosine) {
  const real near = at_least(fma(-fabs(height), per_reach, REAL(1.0)), REAL(0.0));
  const real like = at_least(cosine, REAL(0.0)), square = like * like;
  return near * square * square;
}

#endif
