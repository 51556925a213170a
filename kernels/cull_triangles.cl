// Marks the triangles that may cover a pixel centre: 1, or 2 when the triangle must be clipped first (near plane,
// guard band). Most triangles of a landscape are smaller than a pixel and miss every centre; this straight-line code
// looks at W of them at once, so that the rasteriser's scalar loop sees only the rest.
// One work-group per chunk, one work-item per W triangles.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/guard_band.h"
#include "kernels/shared/real.h"
#include "kernels/shared/triangle_corners.h"

typedef struct {
  real x, y, z;  // W corners: pixels from the principal point, and metres ahead of the eye
} ProjectedCorners;

static inline real along(const float* axis, real x, real y, real z) {
  return fma((real)(axis[0]), x, fma((real)(axis[1]), y, (real)(axis[2]) * z));
}

static inline ProjectedCorners project(const CameraView* camera, real x, real y, real z) {
  ProjectedCorners corners;
  corners.z = along(camera->forward, x, y, z);
  const real scale = (real)(camera->focal) / corners.z;
  corners.x = along(camera->right, x, y, z) * scale;
  corners.y = along(camera->down, x, y, z) * scale;
  return corners;
}

// Whether [low, high] reaches the image and holds a whole number, where pixel centres stand after `shift`. The whole
// number nearest to the middle decides. Corners snap to 1/256 pixel, so the interval is widened by that much.
static inline truth holds_centre(real low, real high, float shift, int pixels) {
  const real middle = REAL(0.5) * (low + high) + (real)(shift), reach = REAL(0.5) * (high - low) + REAL(0.00390625);
  return (fabs(rint(middle) - middle) <= reach) & (middle + reach >= REAL(0.0)) &
         (middle - reach <= (real)((float)(pixels - 1)));
}

static inline BYTES coverage(const CameraView* camera, ProjectedCorners a, ProjectedCorners b, ProjectedCorners c) {
  const real low_x = min(a.x, min(b.x, c.x)), high_x = max(a.x, max(b.x, c.x));
  const real low_y = min(a.y, min(b.y, c.y)), high_y = max(a.y, max(b.y, c.y));
  const real near_plane = (real)(camera->near_plane), guard = (real)(GUARD_BAND);
  const truth covers = holds_centre(low_x, high_x, camera->centre_x - 0.5f, camera->width) &
                       holds_centre(low_y, high_y, camera->centre_y - 0.5f, camera->height);
  const truth ahead = max(a.z, max(b.z, c.z)) > near_plane;
  const truth unclipped =
      (min(a.z, min(b.z, c.z)) > near_plane) & (max(-low_x, high_x) < guard) & (max(-low_y, high_y) < guard);
  return TO_BYTES(PICK(ahead & unclipped & covers, (whole)(1), PICK(ahead & !unclipped, (whole)(2), (whole)(0))));
}

kernel void cull_mesh(global const TriangleChunk* chunks, global const uint* index_a, global const uint* index_b,
                      global const uint* index_c, global const float* x, global const float* y, global const float* z,
                      const CameraView camera, global uchar* marks) {
  global const TriangleChunk* chunk = chunks + get_group_id(0);
  const uint lane = get_local_id(0) * W;
  const uint t = chunk->first_index + lane;
  const bits first = (bits)(chunk->first_vertex);
  const bits ia = first + LOAD(index_a + t, 0), ib = first + LOAD(index_b + t, 0), ic = first + LOAD(index_c + t, 0);
  const ProjectedCorners a = project(&camera, GATHER(real, x, ia, ), GATHER(real, y, ia, ), GATHER(real, z, ia, ));
  const ProjectedCorners b = project(&camera, GATHER(real, x, ib, ), GATHER(real, y, ib, ), GATHER(real, z, ib, ));
  const ProjectedCorners c = project(&camera, GATHER(real, x, ic, ), GATHER(real, y, ic, ), GATHER(real, z, ic, ));
  STORE(coverage(&camera, a, b, c), marks, get_global_id(0));
}

kernel void cull_grass(global const TriangleChunk* chunks, uint first_chunk, global const float* x,
                       global const float* y, global const float* z, const CameraView camera, global uchar* marks) {
  global const TriangleChunk* chunk = chunks + first_chunk + get_group_id(0);
  const uint lane = get_local_id(0) * W;
  const uint ia = chunk->first_vertex + lane, ib = ia + CHUNK, ic = ib + CHUNK;
  const ProjectedCorners a = project(&camera, LOAD(x + ia, 0), LOAD(y + ia, 0), LOAD(z + ia, 0));
  const ProjectedCorners b = project(&camera, LOAD(x + ib, 0), LOAD(y + ib, 0), LOAD(z + ib, 0));
  const ProjectedCorners c = project(&camera, LOAD(x + ic, 0), LOAD(y + ic, 0), LOAD(z + ic, 0));
  STORE(coverage(&camera, a, b, c), marks + first_chunk * CHUNK, get_global_id(0));
}
