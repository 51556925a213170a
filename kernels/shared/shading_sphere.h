// Which positions and spheres count: squares of lengths in units of a radius stay far from the limits of float.
#ifndef UNDERSTORY_SHADING_SPHERE_H
#define UNDERSTORY_SHADING_SPHERE_H

#include "kernels/shared/records.h"
#include "kernels/shared/real.h"

#define FARTHEST 1e12f   // m
#define SMALLEST 1e-6f   // m

/// False for what is not a number.
SHARED truth in_reach(real x, real y, real z) {
  return (fabs(x) < (real)(FARTHEST)) & (fabs(y) < (real)(FARTHEST)) & (fabs(z) < (real)(FARTHEST));
}

/// False for a sphere of no size or opacity, and for what is not a number.
SHARED int sphere_shades(const ShadingSphere sphere) {
  return sphere.radius > SMALLEST && sphere.radius < FARTHEST && sphere.opacity > 0 && fabs(sphere.x) < FARTHEST &&
         fabs(sphere.y) < FARTHEST && fabs(sphere.z) < FARTHEST;
}

#endif
