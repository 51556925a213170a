// Poses far leaves and twigs, one triangle for each, and draws them at once: their vertices are written for what the
// resolve will see of them, and not read back to be drawn. One work-item per W pieces of a unit of 16
// (detail_layout.hpp), whose corners a, b and c stand in three rest blocks one after the other.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/draw_lanes.h"
#include "kernels/shared/posed_lanes.h"

kernel void draw_far(global const float* rest_x, global const float* rest_y, global const float* rest_z,
                     global const char* flutter_x, global const char* flutter_y, global const char* flutter_z,
                     global const uchar* flutter_phase, global const PosedBlock* blocks,
                     global const float* block_scale, global const LimbPose* limbs, global const FarUnit* units,
                     uint items, const CameraView camera, global float4* posed, global VisibleTriangle* pixels) {
  if (get_global_id(0) >= items) return;
  const uint per_block = 16 / W, part = get_global_id(0) % per_block;
  const FarUnit unit = units[get_global_id(0) / per_block];
  const PosedBlock block = blocks[unit.first_block];
  global const LimbPose* limb = limbs + block.limb_pose;
  const size_t rest = (size_t)block.rest_block * per_block + part;
  const uint vertex = unit.first_block * 16 + part * W, triangle = unit.first_triangle + part * W;

  const RestFlutter flutter = {flutter_x, flutter_y, flutter_z, flutter_phase};
  const uint later = get_global_id(0) + UNITS_AHEAD * per_block;
  if (part == 0 && later < items) {
    const size_t later_rest = 16 * (size_t)blocks[units[later / per_block].first_block].rest_block;
    for (uint k = 0; k < 3; ++k) {
      fetch_ahead(rest_x + later_rest + 16 * k);
      fetch_ahead(rest_y + later_rest + 16 * k);
      fetch_ahead(rest_z + later_rest + 16 * k);
    }
    fetch_ahead(flutter_x + later_rest);
    fetch_ahead(flutter_y + later_rest);
    fetch_ahead(flutter_z + later_rest);
    fetch_ahead(flutter_phase + later_rest);
  }
  real x[3], y[3], z[3];
  for (uint k = 0; k < 3; ++k) {
    const size_t at = rest + k * per_block;
    x[k] = LOAD(rest_x, at);
    y[k] = LOAD(rest_y, at);
    z[k] = LOAD(rest_z, at);
  }
  const float scale = block_scale[unit.first_block];
  if (scale != 1.0f) {  // leaves, about their middles
    const real third = REAL(0.33333333333333333);
    const real mx = (x[0] + x[1] + x[2]) * third, my = (y[0] + y[1] + y[2]) * third, mz = (z[0] + z[1] + z[2]) * third;
    for (uint k = 0; k < 3; ++k) {
      x[k] = fma((real)(scale), x[k] - mx, mx);
      y[k] = fma((real)(scale), y[k] - my, my);
      z[k] = fma((real)(scale), z[k] - mz, mz);
    }
  }
  PosedLanes lanes[3];
  ProjectedCorners corners[3];
  for (uint k = 0; k < 3; ++k) {
    lanes[k] = posed_lanes(limb, &flutter, rest + k * per_block, x[k], y[k], z[k]);
    corners[k] = project_corners(&camera, lanes[k]);
  }
  const truth clipped = draw_unclipped(&camera, corners[0], corners[1], corners[2], triangle, pixels);
  // Atomics wait for the stores before them: these have the posing of the next pieces to get to memory.
  for (uint k = 0; k < 3; ++k) store_records(posed_records(lanes[k]), posed, vertex + 16 * k);
  for (uint left = lane_bits(clipped); left != 0;) {
    const uint i = next_lane(&left), a = vertex + i;
    const Corners of_piece = {a, a + 16, a + 32};
    clip_and_scan_convert(&camera, of_piece, posed, triangle + i, pixels);
  }
}
