// Where the three corners of triangle `lane` of a chunk stand in the posed vertex planes.
// Mesh: three index planes, each run padded to whole chunks by triangles without area. Grass: 256 blades side by side,
// so that corner k of lane l is first + 256 k + l.
#ifndef UNDERSTORY_TRIANGLE_CORNERS_H
#define UNDERSTORY_TRIANGLE_CORNERS_H

#include "kernels/shared/records.h"

#define CHUNK 256

typedef struct {
  uint a, b, c;
} Corners;

static inline Corners mesh_corners(global const TriangleChunk* chunk, uint lane, global const uint* index_a,
                                   global const uint* index_b, global const uint* index_c) {
  const uint t = chunk->first_index + lane, first = chunk->first_vertex;
  Corners corners;
  corners.a = first + index_a[t];
  corners.b = first + index_b[t];
  corners.c = first + index_c[t];
  return corners;
}

static inline Corners grass_corners(global const TriangleChunk* chunk, uint lane) {
  Corners corners;
  corners.a = chunk->first_vertex + lane;
  corners.b = corners.a + CHUNK;
  corners.c = corners.b + CHUNK;
  return corners;
}

#endif
