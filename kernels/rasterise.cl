// Scan-converts triangles into the visibility buffer. Corners snap to 1/256 pixel and edges are exact integers,
// inclusive: neighbours that share an edge leave no crack. Depth is perspective-correct (1/z is linear on screen).
// One work-group per chunk; one work-item projects and culls W triangles in vector lanes, then draws those that are
// left.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/project_triangles.h"
#include "kernels/shared/scan_convert.h"
#include "kernels/shared/triangle_corners.h"

// One corner of W triangles as the scalar loop reads it.
typedef struct {
  int x[W], y[W];      // 1/256 pixel
  float inverse_z[W];  // 1/m
} CornerLanes;

static inline void store_lanes(ProjectedCorners corners, CornerLanes* lanes) {
  STORE(snapped(corners.x), lanes->x, 0);
  STORE(snapped(corners.y), lanes->y, 0);
  STORE(corners.inverse_z, lanes->inverse_z, 0);
}

static inline ScreenCorner lane_corner(const CornerLanes* lanes, int lane) {
  ScreenCorner corner;
  corner.x = lanes->x[lane];
  corner.y = lanes->y[lane];
  corner.inverse_z = lanes->inverse_z[lane];
  return corner;
}

// `marks`: coverage per lane. `first`: id of lane 0.
static inline void draw_lanes(const CameraView* camera, ProjectedCorners a, ProjectedCorners b, ProjectedCorners c,
                              const int* marks, uint first, global VisibleTriangle* pixels) {
  CornerLanes as, bs, cs;
  float nearest[W];
  STORE(min(a.z, min(b.z, c.z)) * (real)(INTERPOLATION_SLACK), nearest, 0);
  store_lanes(a, &as);
  store_lanes(b, &bs);
  store_lanes(c, &cs);
  for (int lane = 0; lane < W; ++lane)
    if (marks[lane] == 1)
      scan_convert(camera, lane_corner(&as, lane), lane_corner(&bs, lane), lane_corner(&cs, lane), nearest[lane],
                   first + lane, pixels);
}

kernel void clear_visible(global VisibleTriangle* pixels, uint count) {
  const uint i = get_global_id(0);
  if (i < count) pixels[i] = NOTHING_VISIBLE;
}

kernel void rasterise_mesh(global const TriangleChunk* chunks, global const uint* index_a, global const uint* index_b,
                           global const uint* index_c, global const float4* posed, const CameraView camera,
                           global VisibleTriangle* pixels) {
  const uint id = get_global_id(0) * W, lane = id % CHUNK;  // whatever size of work-group the device grants
  global const TriangleChunk* chunk = chunks + id / CHUNK;
  const uint t = chunk->first_index + lane;
  const uint first = chunk->first_vertex;
  const ProjectedCorners a = project_corners(&camera, gather_posed(posed, first, index_a + t));
  const ProjectedCorners b = project_corners(&camera, gather_posed(posed, first, index_b + t));
  const ProjectedCorners c = project_corners(&camera, gather_posed(posed, first, index_c + t));
  const whole covered = coverage(&camera, a, b, c);
  int marks[W];
  STORE(covered, marks, 0);
  draw_lanes(&camera, a, b, c, marks, id, pixels);
  for (uint i = 0; i < W; ++i)
    if (marks[i] == 2)
      clip_and_scan_convert(&camera, mesh_corners(chunk, lane + i, index_a, index_b, index_c), posed, id + i, pixels);
}

kernel void rasterise_grass(global const TriangleChunk* chunks, uint first_chunk, global const float4* posed,
                            const CameraView camera, global VisibleTriangle* pixels) {
  const uint id = first_chunk * CHUNK + get_global_id(0) * W, lane = id % CHUNK;
  global const TriangleChunk* chunk = chunks + id / CHUNK;
  const Corners corners = grass_corners(chunk, lane);
  const ProjectedCorners a = project_corners(&camera, load_posed(posed, corners.a));
  const ProjectedCorners b = project_corners(&camera, load_posed(posed, corners.b));
  const ProjectedCorners c = project_corners(&camera, load_posed(posed, corners.c));
  const whole covered = coverage(&camera, a, b, c);
  int marks[W];
  STORE(covered, marks, 0);
  draw_lanes(&camera, a, b, c, marks, id, pixels);
  for (uint i = 0; i < W; ++i)
    if (marks[i] == 2) clip_and_scan_convert(&camera, grass_corners(chunk, lane + i), posed, id + i, pixels);
}
