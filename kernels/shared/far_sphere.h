// A sphere far from a tile: its blocked share as a quadratic in the normal n of each fragment,
//   q (c0 + c1 n.u + c2 (n.u)^2),  q = (r/d)^2, u: direction of the sphere,
// with the coefficients of the least largest error over all n:
//   solid_angle_cosine  max(0, n.u)      ~ 1/16 + n.u/2 + (n.u)^2/2    off by at most 1/16 q
//   solid_angle_exact   1/2 if n.u > 0   ~ 1/4 + n.u/4                 off by at most 1/4 q
//   solid_angle         1/2              ~ 1/2                         exact
// Where the tile's normals differ little the share of the middle's normal does better. Errors are in units of q.
#ifndef UNDERSTORY_FAR_SPHERE_H
#define UNDERSTORY_FAR_SPHERE_H

typedef struct {
  float c0, c1, c2;
  float error;        // of the quadratic
  float root_error;   // times r/d: the sphere is no point; q (n.u) lacks 0.22 r/d where the plane cuts it in half
  float slope;        // one normal for all: times the largest |n - n0|
  float step;         // one normal for all, where some fragments' tangent planes may cut the sphere
} FarShare;

#define FAR_COSINE {0.0625f, 0.5f, 0.5f, 0.0625f, 0.25f, 1.0f, 0.0f}
#define FAR_EXACT {0.25f, 0.25f, 0.0f, 0.25f, 0.25f, 0.0f, 0.5f}
#define FAR_PAPER {0.5f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}

#ifdef __OPENCL_C_VERSION__
constant FarShare unit_solid_angle_cosine_far = FAR_COSINE;
constant FarShare unit_solid_angle_exact_far = FAR_EXACT;
constant FarShare unit_solid_angle_far = FAR_PAPER;
#endif
#endif
