// Scan-converts triangles into the visibility buffer. Corners snap to 1/256 pixel and edges are exact integers,
// inclusive: neighbours that share an edge leave no crack. Depth is perspective-correct (1/z is linear on screen).
// One work-group per chunk; one work-item projects and culls W triangles in vector lanes, then draws those that are
// left.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/draw_lanes.h"

kernel void clear_visible(global VisibleTriangle* pixels, uint count) {
  const uint i = get_global_id(0);
  if (i < count) pixels[i] = NOTHING_VISIBLE;
}

kernel void rasterise_mesh(global const TriangleChunk* chunks, global const uint* index_a, global const uint* index_b,
                           global const uint* index_c, global const float4* posed, const CameraView camera,
                           global VisibleTriangle* pixels) {
  const uint id = get_global_id(0) * W, lane = id % CHUNK;  // whatever size of work-group the device grants
  global const TriangleChunk* chunk = chunks + id / CHUNK;
  if (lane >= chunk->count) return;
  const uint t = chunk->first_index + lane;
  const uint first = chunk->first_vertex;
  const ProjectedCorners a = project_corners(&camera, gather_posed(posed, first, index_a + t));
  const ProjectedCorners b = project_corners(&camera, gather_posed(posed, first, index_b + t));
  const ProjectedCorners c = project_corners(&camera, gather_posed(posed, first, index_c + t));
  const truth clipped = draw_unclipped(&camera, a, b, c, id, pixels);
  for (uint left = lane_bits(clipped); left != 0;) {
    const uint i = next_lane(&left);
    clip_and_scan_convert(&camera, mesh_corners(chunk, lane + i, index_a, index_b, index_c), posed, id + i, pixels);
  }
}

kernel void rasterise_grass(global const TriangleChunk* chunks, uint first_chunk, global const float4* posed,
                            const CameraView camera, global VisibleTriangle* pixels) {
  const uint id = first_chunk * CHUNK + get_global_id(0) * W, lane = id % CHUNK;
  global const TriangleChunk* chunk = chunks + id / CHUNK;
  if (lane >= chunk->count) return;
  const Corners corners = grass_corners(chunk, lane);
  const ProjectedCorners a = project_corners(&camera, load_posed(posed, corners.a));
  const ProjectedCorners b = project_corners(&camera, load_posed(posed, corners.b));
  const ProjectedCorners c = project_corners(&camera, load_posed(posed, corners.c));
  const truth clipped = draw_unclipped(&camera, a, b, c, id, pixels);
  for (uint left = lane_bits(clipped); left != 0;) {
    const uint i = next_lane(&left);
    clip_and_scan_convert(&camera, grass_corners(chunk, lane + i), posed, id + i, pixels);
  }
}
