// Marks the triangles that may cover a pixel centre: 1, or 2 when the triangle must be clipped first (near plane,
// guard band). Most triangles of a landscape are smaller than a pixel and miss every centre; this straight-line code
// runs across work-items in vector lanes, so that the rasteriser's scalar loop sees only the rest.
// One work-group per chunk, one work-item per triangle.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/camera.h"
#include "kernels/shared/guard_band.h"
#include "kernels/shared/triangle_corners.h"

uchar coverage(const CameraView* camera, Corners corners, global const float* x, global const float* y,
               global const float* z) {
  const ViewPoint a = view_point(camera, x[corners.a], y[corners.a], z[corners.a]);
  const ViewPoint b = view_point(camera, x[corners.b], y[corners.b], z[corners.b]);
  const ViewPoint c = view_point(camera, x[corners.c], y[corners.c], z[corners.c]);
  const float nearest = fmin(a.z, fmin(b.z, c.z)), farthest = fmax(a.z, fmax(b.z, c.z));
  const float fa = camera->focal / a.z, fb = camera->focal / b.z, fc = camera->focal / c.z;
  const float xa = a.x * fa, xb = b.x * fb, xc = c.x * fc, ya = a.y * fa, yb = b.y * fb, yc = c.y * fc;
  const float low_x = fmin(xa, fmin(xb, xc)), high_x = fmax(xa, fmax(xb, xc));
  const float low_y = fmin(ya, fmin(yb, yc)), high_y = fmax(ya, fmax(yb, yc));

  // Centres stand at whole numbers after this shift; corners snap to 1/256 pixel, so widen by that much.
  const float shift_x = camera->centre_x - 0.5f, shift_y = camera->centre_y - 0.5f, snap = 1.0f / 256;
  const float first_x = ceil(low_x + shift_x - snap), last_x = floor(high_x + shift_x + snap);
  const float first_y = ceil(low_y + shift_y - snap), last_y = floor(high_y + shift_y + snap);
  const int covers = (fmax(first_x, 0.0f) <= fmin(last_x, (float)(camera->width - 1))) &
                     (fmax(first_y, 0.0f) <= fmin(last_y, (float)(camera->height - 1)));
  const int ahead = farthest > camera->near_plane;
  const int whole = (nearest > camera->near_plane) & (fmax(fabs(low_x), high_x) < GUARD_BAND) &
                    (fmax(fabs(low_y), high_y) < GUARD_BAND);
  return (uchar)(ahead & whole & covers) | (uchar)((ahead & !whole) << 1);
}

kernel void cull_mesh(global const TriangleChunk* chunks, global const uint* index_a, global const uint* index_b,
                      global const uint* index_c, global const float* x, global const float* y,
                      global const float* z, const CameraView camera, global uchar* marks) {
  const TriangleChunk chunk = chunks[get_group_id(0)];
  const uint lane = get_local_id(0), inside = min(lane, chunk.count - 1);
  const uchar mark = coverage(&camera, mesh_corners(chunk, inside, index_a, index_b, index_c), x, y, z);
  marks[get_global_id(0)] = lane < chunk.count ? mark : (uchar)0;
}

kernel void cull_grass(global const TriangleChunk* chunks, uint first_chunk, global const float* x,
                       global const float* y, global const float* z, const CameraView camera, global uchar* marks) {
  const TriangleChunk chunk = chunks[first_chunk + get_group_id(0)];
  const uint lane = get_local_id(0);
  const uchar mark = coverage(&camera, grass_corners(chunk, lane), x, y, z);
  marks[first_chunk * CHUNK + get_global_id(0)] = lane < chunk.count ? mark : (uchar)0;
}
