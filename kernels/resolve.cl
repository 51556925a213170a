// Turns visible triangles into planes: position on the triangle under the pixel's sample, face normal turned to the
// viewer (leaves are two-sided), camera depth, owner, validity; with -DGRASS_HEIGHT also the height of a blade's
// fragment above its root and the blade's length, or the height of the mesh it is part of; with -DREST_POINT also where
// a mesh fragment and its face normal were at rest, prototype frame; with -DFACE_TEXEL the texel of its face
// (crown_baked.h). One work-item per W fragments: their triangles lie anywhere in memory, so that the loads of all of
// them come first and wait for it side by side. Padded fragments are background.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/camera.h"
#include "kernels/shared/crown_baked.h"
#include "kernels/shared/fetch_ahead.h"
#include "kernels/shared/real.h"
#include "kernels/shared/rest_point.h"
#include "kernels/shared/triangle_corners.h"
#include "kernels/shared/visibility_buffer.h"

#define BACKGROUND 1u  // validity code (FORMULAS.md)

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
  Corners corners_of[W];
  float4 first_corner[W], second_corner[W], third_corner[W];
  for (uint k = 0; k < W; ++k)
    triangles[k] = begin + k < count ? visible_triangle(pixels, count, begin + k) : NO_TRIANGLE;
  for (uint k = 0; k < W; ++k) {
    if (triangles[k] / CHUNK >= mesh_chunks) continue;
    const uint t = chunks[triangles[k] / CHUNK].first_index + triangles[k] % CHUNK;
    fetch_ahead(index_a + t);
    fetch_ahead(index_b + t);
    fetch_ahead(index_c + t);
  }
  for (uint k = 0; k < W; ++k) {
    if (triangles[k] == NO_TRIANGLE) continue;
    global const TriangleChunk* chunk = chunks + triangles[k] / CHUNK;
    corners_of[k] = triangles[k] / CHUNK < mesh_chunks
                        ? mesh_corners(chunk, triangles[k] % CHUNK, index_a, index_b, index_c)
                        : grass_corners(chunk, triangles[k] % CHUNK);
    fetch_ahead(posed + corners_of[k].a);
    fetch_ahead(posed + corners_of[k].b);
    fetch_ahead(posed + corners_of[k].c);
  }
  for (uint k = 0; k < W; ++k) {
    if (triangles[k] == NO_TRIANGLE) continue;
    first_corner[k] = posed[corners_of[k].a];
    second_corner[k] = posed[corners_of[k].b];
    third_corner[k] = posed[corners_of[k].c];
  }

  for (uint k = 0; k < W; ++k) {
    const uint i = begin + k, triangle = triangles[k];
    if (triangle == NO_TRIANGLE && !first_batch) continue;  // written by an earlier batch
    if (triangle != NO_TRIANGLE && !last_batch) forget_triangle(pixels, count, i);
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
    if (triangle == NO_TRIANGLE) {
      position_x[i] = position_y[i] = position_z[i] = 0;
      normal_x[i] = normal_y[i] = normal_z[i] = 0;
      depth[i] = INFINITY;
      owner[i] = 0;
      validity[i] = BACKGROUND;
      continue;
    }

    global const TriangleChunk* chunk = chunks + triangle / CHUNK;
#if defined(GRASS_HEIGHT) || defined(REST_POINT) || defined(FACE_TEXEL)
    const int is_mesh = triangle / CHUNK < mesh_chunks;
#endif
    const float4 a = first_corner[k], b = second_corner[k], c = third_corner[k];
    const float ax = a.x, ay = a.y, az = a.z;
    const float ux = b.x - ax, uy = b.y - ay, uz = b.z - az, vx = c.x - ax, vy = c.y - ay, vz = c.z - az;

    // The ray through the pixel's sample; its forward component is 1, so that its parameter is the camera depth.
    const float right = ((float)(i % (uint)camera.width) + 0.5f - camera.centre_x) / camera.focal;
    const float down = ((float)(i / (uint)camera.width) + 0.5f - camera.centre_y) / camera.focal;
    const float rx = fma(right, camera.right[0], fma(down, camera.down[0], camera.forward[0]));
    const float ry = fma(right, camera.right[1], fma(down, camera.down[1], camera.forward[1]));
    const float rz = fma(right, camera.right[2], fma(down, camera.down[2], camera.forward[2]));

    float nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    const float scale = rsqrt(fmax(nx * nx + ny * ny + nz * nz, 1e-37f));
    nx *= scale;
    ny *= scale;
    nz *= scale;
    const float facing = nx * rx + ny * ry + nz * rz;

    // Seen edge-on the plane says little about depth: keep it within the triangle's own range.
    const float za = view_point(&camera, ax, ay, az).z, zb = za + view_point(&camera, ux, uy, uz).z,
                zc = za + view_point(&camera, vx, vy, vz).z;
    const float nearest = fmax(fmin(za, fmin(zb, zc)), camera.near_plane), farthest = fmax(za, fmax(zb, zc));
    const float on_plane = (nx * ax + ny * ay + nz * az) / (fabs(facing) > 1e-12f ? facing : 1e-12f);
    const float t = fmin(fmax(on_plane, nearest), farthest);

    position_x[i] = t * rx;
    position_y[i] = t * ry;
    position_z[i] = t * rz;
    const float turn = facing > 0 ? -1.0f : 1.0f;
    normal_x[i] = nx * turn;
    normal_y[i] = ny * turn;
    normal_z[i] = nz * turn;
    depth[i] = t;
    owner[i] = chunk->owner;
    validity[i] = 0;
#ifdef GRASS_HEIGHT
    if (!is_mesh) {
      const uint blade = chunk->first_index + triangle % CHUNK;
      height_above_root[i] = t * rz - (blade_root_z[blade] + root_offset_z);
      total_height[i] = blade_length[blade];
    } else if (owner_height[chunk->owner] > 0) {
      height_above_root[i] = t * rz - (owner_root_z[chunk->owner] + root_offset_z);
      total_height[i] = owner_height[chunk->owner];
    }
#endif
#if defined(REST_POINT) || defined(FACE_TEXEL)
    const float2 place =
        place_in_triangle((float3)(ux, uy, uz), (float3)(vx, vy, vz), (float3)(t * rx - ax, t * ry - ay, t * rz - az));
#endif
#ifdef FACE_TEXEL
    if (is_mesh) {
      const uint2 face = faces[chunk->first_index + triangle % CHUNK];
      const uint columns = FACE_COLUMNS(face), rows = FACE_ROWS(face);
      if (columns != 0) {
        const float x = place.x * (float)columns, y = place.y * (float)rows;
        const uint column = min((uint)x, columns - 1), row = min((uint)y, rows - 1);
        const uint back = facing > 0 ? columns * rows : 0;  // seen from behind
        texel[i] = face.x + back + row * columns + column;
        texel_place[i] = (uint)((x - (float)column) * TEXEL_FRACTIONS) | (uint)((y - (float)row) * TEXEL_FRACTIONS)
                                                                             << 16;
      }
    }
#endif
#ifdef REST_POINT
    if (is_mesh) {
      const float3 origin = rest_vertex(corners_of[k].a, blocks, rest_x, rest_y, rest_z);
      const float3 u = rest_vertex(corners_of[k].b, blocks, rest_x, rest_y, rest_z) - origin;
      const float3 v = rest_vertex(corners_of[k].c, blocks, rest_x, rest_y, rest_z) - origin;
      const float3 point = origin + place.x * u + place.y * v;
      float3 normal = cross(u, v);
      normal *= turn * rsqrt(fmax(dot(normal, normal), 1e-37f));
      rest_position_x[i] = point.x;
      rest_position_y[i] = point.y;
      rest_position_z[i] = point.z;
      rest_normal_x[i] = normal.x;
      rest_normal_y[i] = normal.y;
      rest_normal_z[i] = normal.z;
    }
#endif
  }
}
