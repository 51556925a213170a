// Which positions and spheres count: squares of lengths in units of a radius stay far from the limits of float.
#ifndef UNDERSTORY_SHADING_SPHERE_H
#define UNDERSTORY_SHADING_SPHERE_H

#include "kernels/shared/records.h"
#include "kernels/shared/real.h"

#define FARTHEST 1e12f   // m
#define SMALLEST 9e-7f   // m: 1e-6 counts

/// False for what is not a number.
SHARED truth in_reach(real x, real y, real z) {
  return (fabs(x) < (real)(FARTHEST)) & (fabs(y) < (real)(FARTHEST)) & (fabs(z) < (real)(FARTHEST));
}

/// False for a sphere of no size or opacity, and for what is not a number.
SHARED int sphere_shades(const ShadingSphere sphere) {
  return sphere.radius > SMALLEST && sphere.radius < FARTHEST && sphere.opacity > 0 && fabs(sphere.x) < FARTHEST &&
         fabs(sphere.y) < FARTHEST && fabs(sphere.z) < FARTHEST;
}

/// A sphere as fragments see it, in units of its radius: the centre's height above the tangent plane, distance squared.
typedef struct {
  real height, square;
} SphereView;

/// (x, y, z): fragments, m; (a, b, c): their unit normals. `scale`: 1/radius, which lists keep (tile_spheres.cl), for a
/// division by fragment and sphere is a seventh of the shading's time.
SHARED SphereView view_sphere(const ShadingSphere sphere, float scale, real x, real y, real z, real a, real b, real c) {
  const real dx = (real)(sphere.x) - x, dy = (real)(sphere.y) - y, dz = (real)(sphere.z) - z;
  const SphereView view = {fma(dx, a, fma(dy, b, dz * c)) * scale,
                           fma(dx, dx, fma(dy, dy, dz * dz)) * (scale * scale)};
  return view;
}

#endif
