// Bends every blade of one field in the wind of time t and writes its 7 vertices. One work-item per blade; groups of
// 256 blades write vertex k of lane l at 7 * 256 * group + 256 k + l, so that stores and triangle corners are
// contiguous (triangle_corners.h). Straight-line code: runs across work-items in vector lanes, hence W = 1.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/grass_bend.h"
#include "kernels/shared/pose_blade.h"
#include "kernels/shared/records.h"
#include "kernels/shared/triangle_corners.h"

#define LARGEST_BEND 2.5f  // radians: where arc.h is proven

float2 look_up(global const float2* series, uint mask, float sample) {
  const float whole = floor(sample), part = sample - whole;
  const uint i = (uint)(int)whole;
  const float2 before = series[i & mask], after = series[(i + 1) & mask];
  return before + part * (after - before);
}

void store_point(global float* x, global float* y, global float* z, uint at, float px, float py, float pz) {
  x[at] = px;
  y[at] = py;
  z[at] = pz;
}

kernel void pose_grass(global const float* root_x, global const float* root_y, global const float* root_z,
                       global const float* length, global const float* half_width, global const float* rest_x,
                       global const float* rest_y, global const float* facing_x, global const float* facing_y,
                       global const float* flexibility, global const float* phase, const GrassWind wind,
                       global const float2* series, uint first_blade, uint first_vertex, global float* x,
                       global float* y, global float* z) {
  const uint blade = first_blade + get_global_id(0);
  const uint vertex = first_vertex + 7 * CHUNK * get_group_id(0) + get_local_id(0);
  const uint mask = wind.series_count - 1;

  const GrassGust gust = grass_gust(wind, root_x[blade], root_y[blade]);
  const float2 first = look_up(series, mask, gust.sample);
  const float2 second = look_up(series, mask, gust.sample + (float)(wind.series_count / 2));
  const float2 both = gust.first_share * first + gust.second_share * second;
  GrassBend bend = grass_bend(wind, both.x, both.y, rest_x[blade], rest_y[blade], flexibility[blade], phase[blade]);
  const float angle = sqrt(bend.x * bend.x + bend.y * bend.y);
  const float limited = fmin(1.0f, LARGEST_BEND / fmax(angle, LARGEST_BEND));
  bend.x *= limited;
  bend.y *= limited;

  const float ox = root_x[blade] + wind.root_offset_x, oy = root_y[blade] + wind.root_offset_y,
              oz = root_z[blade] + wind.root_offset_z, size = length[blade];
  const float wx = facing_x[blade] * half_width[blade], wy = facing_y[blade] * half_width[blade];
  const BladePoint middle = blade_midline(size, bend.x, bend.y, 0.4f);
  const BladePoint upper = blade_midline(size, bend.x, bend.y, 0.75f);
  const BladePoint tip = blade_midline(size, bend.x, bend.y, 1.0f);

  store_point(x, y, z, vertex, ox - wx, oy - wy, oz);
  store_point(x, y, z, vertex + CHUNK, ox + wx, oy + wy, oz);
  store_point(x, y, z, vertex + 2 * CHUNK, ox + middle.x - 0.85f * wx, oy + middle.y - 0.85f * wy, oz + middle.z);
  store_point(x, y, z, vertex + 3 * CHUNK, ox + middle.x + 0.85f * wx, oy + middle.y + 0.85f * wy, oz + middle.z);
  store_point(x, y, z, vertex + 4 * CHUNK, ox + upper.x - 0.5f * wx, oy + upper.y - 0.5f * wy, oz + upper.z);
  store_point(x, y, z, vertex + 5 * CHUNK, ox + upper.x + 0.5f * wx, oy + upper.y + 0.5f * wy, oz + upper.z);
  store_point(x, y, z, vertex + 6 * CHUNK, ox + tip.x, oy + tip.y, oz + tip.z);
}
