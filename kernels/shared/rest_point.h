// Where a visible point was when the plant stood at rest: by its place in the triangle, whose rest corners are known.
#ifndef UNDERSTORY_REST_POINT_H
#define UNDERSTORY_REST_POINT_H

#include "kernels/shared/triangle_corners.h"

/// Shares of corners b and c of the triangle a, a + u, a + v at a + w, within [0, 1], their sum too.
static inline float2 place_in_triangle(float3 u, float3 v, float3 w) {
  const float uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), wu = dot(w, u), wv = dot(w, v);
  const float scale = 1.0f / fmax(uu * vv - uv * uv, 1e-37f);
  const float b = fmin(fmax((vv * wu - uv * wv) * scale, 0.0f), 1.0f);
  const float c = fmin(fmax((uu * wv - uv * wu) * scale, 0.0f), 1.0f);
  return (float2)(b, c) / fmax(b + c, 1.0f);
}

static inline float3 rest_vertex(uint posed, global const PosedBlock* blocks, global const float* rest_x,
                                 global const float* rest_y, global const float* rest_z) {
  const uint rest = blocks[posed / 16].rest_block * 16 + posed % 16;
  return (float3)(rest_x[rest], rest_y[rest], rest_z[rest]);
}

#endif
