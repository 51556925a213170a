// A sphere far from a tile: its blocked share as a quadratic in the normal n of each fragment,
//   q (c0 + c1 n.u + c2 (n.u)^2),  q = (r/d)^2, u: direction of the sphere,
// with the coefficients of the least largest error over all n:
//   solid_angle_cosine  max(0, n.u)      ~ 1/16 + n.u/2 + (n.u)^2/2    off by at most 1/16 q
//   solid_angle_exact   1/2 if n.u > 0   ~ 1/4 + n.u/4                 off by at most 1/4 q
//   solid_angle         1/2              ~ 1/2                         exact
// where d is at least 4 r. Errors are in units of q.
#ifndef UNDERSTORY_FAR_SPHERE_H
#define UNDERSTORY_FAR_SPHERE_H

typedef struct {
  float c0, c1, c2;
  float error;       // of the quadratic
  float root_error;  // times r/d: the sphere is no point, and its share begins where its rim crosses the plane
  float moved;       // times |x - x0|/d: a fragment at x instead of x0; q u is the field of a mass, its gradient 2 q/d
} FarShare;

#define FAR_COSINE {0.0625f, 0.5f, 0.5f, 0.0625f, 0.0f, 2.0f}
#define FAR_EXACT {0.25f, 0.25f, 0.0f, 0.25f, 0.25f, 1.1f}
#define FAR_PAPER {0.5f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f}

#ifdef __OPENCL_C_VERSION__
constant FarShare unit_solid_angle_cosine_far = FAR_COSINE;
constant FarShare unit_solid_angle_exact_far = FAR_EXACT;
constant FarShare unit_solid_angle_far = FAR_PAPER;
#endif
#endif
