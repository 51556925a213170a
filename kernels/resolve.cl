// Turns visible triangles into planes: position on the triangle under the pixel's sample, face normal turned to the
// viewer (leaves are two-sided), camera depth, owner, validity; with -DGRASS_HEIGHT also the height of a blade's
// fragment above its root and the blade's length, or the height of the mesh it is part of; with -DREST_POINT also where
// a mesh fragment and its face normal were at rest, prototype frame; with -DFACE_TEXEL the texel of its face
// (crown_baked.h). One work-item per W fragments: their triangles lie anywhere in memory, so that work-items ask for
// what the next two of them will read. Padded fragments are background.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/crown_baked.h"
#include "kernels/shared/fetch_ahead.h"
#include "kernels/shared/project_triangles.h"
#include "kernels/shared/rest_point.h"
#include "kernels/shared/triangle_corners.h"
#include "kernels/shared/visibility_buffer.h"

#define BACKGROUND 1u  // validity code (FORMULAS.md)

static inline Corners corners_of(global const TriangleChunk* chunks, uint mesh_chunks, uint triangle,
                                 global const uint* index_a, global const uint* index_b, global const uint* index_c) {
  global const TriangleChunk* chunk = chunks + triangle / CHUNK;
  return triangle / CHUNK < mesh_chunks ? mesh_corners(chunk, triangle % CHUNK, index_a, index_b, index_c)
                                        : grass_corners(chunk, triangle % CHUNK);
}

kernel void resolve(global VisibleTriangle* pixels, global const TriangleChunk* chunks, uint mesh_chunks,
                    global const uint* index_a, global const uint* index_b, global const uint* index_c,
                    global const float4* posed, const CameraView camera, uint padded_fragments,
                    uint first_batch, uint last_batch,
                    global float* position_x, global float* position_y, global float* position_z,
                    global float* normal_x, global float* normal_y, global float* normal_z, global float* depth,
                    global uint* owner, global uint* validity
#ifdef GRASS_HEIGHT
                    ,
                    global const float* blade_root_z, global const float* blade_length,
                    global const float* owner_root_z, global const float* owner_height, float root_offset_z,
                    global float* height_above_root, global float* total_height
#endif
#ifdef REST_POINT
                    ,
                    global const PosedBlock* blocks, global const float* rest_x, global const float* rest_y,
                    global const float* rest_z, global float* rest_position_x, global float* rest_position_y,
                    global float* rest_position_z, global float* rest_normal_x, global float* rest_normal_y,
                    global float* rest_normal_z
#endif
#ifdef FACE_TEXEL
                    ,
                    global const uint2* faces, global uint* texel, global uint* texel_place
#endif
) {
  const uint begin = get_global_id(0) * W;
  if (begin >= padded_fragments) return;
  const uint count = (uint)camera.width * (uint)camera.height;
  uint triangles[W];
  int seen_lanes[W];
  uint owner_lanes[W];
  float corner[9][W];  // x, y, z of corners a, b, c
  float column[W], row[W];
  for (uint k = 0; k < W; ++k)
    triangles[k] = begin + k < count ? visible_triangle(pixels, count, begin + k) : NO_TRIANGLE;
  // Two work-items ahead the corners' places are asked for, one ahead the corners. Not while others forget theirs.
  const uint ahead = last_batch ? W : 0;
  for (uint k = 0; k < W; ++k) {
    const uint i = begin + 2 * ahead + k;
    const uint later = i < count ? visible_triangle(pixels, count, i) : NO_TRIANGLE;
    if (later / CHUNK >= mesh_chunks) continue;
    const uint t = chunks[later / CHUNK].first_index + later % CHUNK;
    fetch_ahead(index_a + t);
    fetch_ahead(index_b + t);
    fetch_ahead(index_c + t);
  }
  for (uint k = 0; k < W; ++k) {
    const uint i = begin + ahead + k;
    const uint next = i < count ? visible_triangle(pixels, count, i) : NO_TRIANGLE;
    if (next == NO_TRIANGLE) continue;
    const Corners corners = corners_of(chunks, mesh_chunks, next, index_a, index_b, index_c);
    fetch_ahead(posed + corners.a);
    fetch_ahead(posed + corners.b);
    fetch_ahead(posed + corners.c);
#ifdef GRASS_HEIGHT
    if (next / CHUNK < mesh_chunks) continue;
    const uint blade = chunks[next / CHUNK].first_index + next % CHUNK;
    fetch_ahead(blade_root_z + blade);
    fetch_ahead(blade_length + blade);
#endif
  }
  for (uint k = 0, x = begin % (uint)camera.width, y = begin / (uint)camera.width; k < W; ++k) {
    const int seen = triangles[k] != NO_TRIANGLE;
    float4 a = (float4)(0.0f), b = a, c = a;
    seen_lanes[k] = seen;
    owner_lanes[k] = 0;
    if (seen) {
      const Corners corners = corners_of(chunks, mesh_chunks, triangles[k], index_a, index_b, index_c);
      owner_lanes[k] = chunks[triangles[k] / CHUNK].owner;
      a = posed[corners.a];
      b = posed[corners.b];
      c = posed[corners.c];
    }
    corner[0][k] = a.x, corner[1][k] = a.y, corner[2][k] = a.z;
    corner[3][k] = b.x, corner[4][k] = b.y, corner[5][k] = b.z;
    corner[6][k] = c.x, corner[7][k] = c.y, corner[8][k] = c.z;
    column[k] = (float)x;
    row[k] = (float)y;
    if (++x == (uint)camera.width) x = 0, ++y;
  }

  const truth seen = LOAD(seen_lanes, 0) != 0;
  const PosedLanes a = {LOAD(corner[0], 0), LOAD(corner[1], 0), LOAD(corner[2], 0)};
  const PosedLanes u = {LOAD(corner[3], 0) - a.x, LOAD(corner[4], 0) - a.y, LOAD(corner[5], 0) - a.z};
  const PosedLanes v = {LOAD(corner[6], 0) - a.x, LOAD(corner[7], 0) - a.y, LOAD(corner[8], 0) - a.z};

  // The ray through the pixel's sample; its forward component is 1, so that its parameter is the camera depth.
  const real right = (LOAD(column, 0) + REAL(0.5) - (real)(camera.centre_x)) / (real)(camera.focal);
  const real down = (LOAD(row, 0) + REAL(0.5) - (real)(camera.centre_y)) / (real)(camera.focal);
  const real rx = fma(right, (real)(camera.right[0]), fma(down, (real)(camera.down[0]), (real)(camera.forward[0])));
  const real ry = fma(right, (real)(camera.right[1]), fma(down, (real)(camera.down[1]), (real)(camera.forward[1])));
  const real rz = fma(right, (real)(camera.right[2]), fma(down, (real)(camera.down[2]), (real)(camera.forward[2])));

  real nx = u.y * v.z - u.z * v.y, ny = u.z * v.x - u.x * v.z, nz = u.x * v.y - u.y * v.x;
  const real scale = REAL(1.0) / sqrt(max(nx * nx + ny * ny + nz * nz, REAL(1e-37)));
  nx *= scale;
  ny *= scale;
  nz *= scale;
  const real facing = nx * rx + ny * ry + nz * rz;

  // Seen edge-on the plane says little about depth: keep it within the triangle's own range.
  const real za = along(camera.forward, a), zb = za + along(camera.forward, u), zc = za + along(camera.forward, v);
  const real nearest = max(min(za, min(zb, zc)), (real)(camera.near_plane)), farthest = max(za, max(zb, zc));
  const real slope = PICK(fabs(facing) > REAL(1e-12), facing, REAL(1e-12));
  const real t = min(max((nx * a.x + ny * a.y + nz * a.z) / slope, nearest), farthest);
  const real turn = PICK(facing > REAL(0.0), REAL(-1.0), REAL(1.0));

  // After the first batch pixels that this one does not cover keep what an earlier one wrote.
#define WRITE(type, plane, value, background)                                                          \
  STORE(PICK(seen, value, first_batch ? (type)(background) : LOAD(plane, get_global_id(0))), plane, \
        get_global_id(0))
  WRITE(real, position_x, t * rx, 0.0f);
  WRITE(real, position_y, t * ry, 0.0f);
  WRITE(real, position_z, t * rz, 0.0f);
  WRITE(real, normal_x, nx * turn, 0.0f);
  WRITE(real, normal_y, ny * turn, 0.0f);
  WRITE(real, normal_z, nz * turn, 0.0f);
  WRITE(real, depth, t, INFINITY);
  WRITE(bits, owner, LOAD(owner_lanes, 0), 0u);
  WRITE(bits, validity, (bits)(0u), BACKGROUND);
#undef WRITE
  for (uint k = 0; k < W && !last_batch; ++k)
    if (triangles[k] != NO_TRIANGLE) forget_triangle(pixels, count, begin + k);

#if defined(GRASS_HEIGHT) || defined(REST_POINT) || defined(FACE_TEXEL)
  float seen_x[W], seen_y[W], seen_z[W], turns[W];
  STORE(t * rx, seen_x, 0);
  STORE(t * ry, seen_y, 0);
  STORE(t * rz, seen_z, 0);
  STORE(turn, turns, 0);
  for (uint k = 0; k < W; ++k) {
    const uint i = begin + k, triangle = triangles[k];
    if (triangle == NO_TRIANGLE && !first_batch) continue;  // written by an earlier batch
#ifdef GRASS_HEIGHT
    height_above_root[i] = 0;
    total_height[i] = 0;
#endif
#ifdef REST_POINT
    rest_position_x[i] = rest_position_y[i] = rest_position_z[i] = 0;
    rest_normal_x[i] = rest_normal_y[i] = rest_normal_z[i] = 0;
#endif
#ifdef FACE_TEXEL
    texel[i] = NO_TEXEL;
    texel_place[i] = 0;
#endif
    if (triangle == NO_TRIANGLE) continue;
    global const TriangleChunk* chunk = chunks + triangle / CHUNK;
    const int is_mesh = triangle / CHUNK < mesh_chunks;
#ifdef GRASS_HEIGHT
    if (!is_mesh) {
      const uint blade = chunk->first_index + triangle % CHUNK;
      height_above_root[i] = seen_z[k] - (blade_root_z[blade] + root_offset_z);
      total_height[i] = blade_length[blade];
    } else if (owner_height[chunk->owner] > 0) {
      height_above_root[i] = seen_z[k] - (owner_root_z[chunk->owner] + root_offset_z);
      total_height[i] = owner_height[chunk->owner];
    }
#endif
#if defined(REST_POINT) || defined(FACE_TEXEL)
    const float3 from = (float3)(corner[0][k], corner[1][k], corner[2][k]);
    const float2 place = place_in_triangle((float3)(corner[3][k], corner[4][k], corner[5][k]) - from,
                                           (float3)(corner[6][k], corner[7][k], corner[8][k]) - from,
                                           (float3)(seen_x[k], seen_y[k], seen_z[k]) - from);
#endif
#ifdef FACE_TEXEL
    if (is_mesh) {
      const uint2 face = faces[chunk->first_index + triangle % CHUNK];
      const uint columns = FACE_COLUMNS(face), rows = FACE_ROWS(face);
      if (columns != 0) {
        const float x = place.x * (float)columns, y = place.y * (float)rows;
        const uint column = min((uint)x, columns - 1), row = min((uint)y, rows - 1);
        const uint back = turns[k] < 0 ? columns * rows : 0;  // seen from behind
        texel[i] = face.x + back + row * columns + column;
        texel_place[i] = texel_place_of(x - (float)column, y - (float)row, face_tilt(face, normal_z[i], turns[k]));
      }
    }
#endif
#ifdef REST_POINT
    if (is_mesh) {
      const Corners corners = corners_of(chunks, mesh_chunks, triangle, index_a, index_b, index_c);
      const float3 origin = rest_vertex(corners.a, blocks, rest_x, rest_y, rest_z);
      const float3 u = rest_vertex(corners.b, blocks, rest_x, rest_y, rest_z) - origin;
      const float3 v = rest_vertex(corners.c, blocks, rest_x, rest_y, rest_z) - origin;
      const float3 point = origin + place.x * u + place.y * v;
      float3 normal = cross(u, v);
      normal *= turns[k] * rsqrt(fmax(dot(normal, normal), 1e-37f));
      rest_position_x[i] = point.x;
      rest_position_y[i] = point.y;
      rest_position_z[i] = point.z;
      rest_normal_x[i] = normal.x;
      rest_normal_y[i] = normal.y;
      rest_normal_z[i] = normal.z;
    }
#endif
  }
#endif
}
