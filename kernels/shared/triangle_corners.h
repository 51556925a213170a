// Where the three corners of triangle `lane` of a chunk stand in the posed vertex planes.
// Mesh: three index planes. Grass: 256 blades side by side, so that corner k of lane l is first + 256 k + l.
#ifndef UNDERSTORY_TRIANGLE_CORNERS_H
#define UNDERSTORY_TRIANGLE_CORNERS_H

#include "kernels/shared/records.h"

#define CHUNK 256

typedef struct {
  uint a, b, c;
} Corners;

Corners mesh_corners(const TriangleChunk chunk, uint lane, global const uint* index_a, global const uint* index_b,
                     global const uint* index_c) {
  const uint t = chunk.first_index + lane;
  Corners corners;
  corners.a = chunk.first_vertex + index_a[t];
  corners.b = chunk.first_vertex + index_b[t];
  corners.c = chunk.first_vertex + index_c[t];
  return corners;
}

Corners grass_corners(const TriangleChunk chunk, uint lane) {
  Corners corners;
  corners.a = chunk.first_vertex + lane;
  corners.b = corners.a + CHUNK;
  corners.c = corners.b + CHUNK;
  return corners;
}

#endif
