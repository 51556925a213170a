// Moves the rest vertices of every instance to where they are at time t: leaf flutter, then the bend of the limb,
// then the limb's rigid transform (records.h, LimbPose). One work-item poses W vertices of one block of 16.
// With -DTHINNED the leaves of each block are first enlarged about their middles.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/fetch_ahead.h"
#include "kernels/shared/posed_lanes.h"
#include "kernels/shared/posed_vertices.h"
#include "kernels/shared/records.h"

kernel void pose_mesh(global const float* rest_x, global const float* rest_y, global const float* rest_z,
                      global const char* flutter_x, global const char* flutter_y, global const char* flutter_z,
                      global const uchar* flutter_phase, global const PosedBlock* blocks, global const LimbPose* limbs,
                      global float4* posed, uint items
#ifdef THINNED
                      ,
                      global const float* pivot_x, global const float* pivot_y, global const float* pivot_z,
                      global const float* block_scale
#endif
) {
  const size_t i = get_global_id(0);
  if (i >= items) return;
  const uint per_block = 16 / W;
  const PosedBlock block = blocks[i / per_block];
  const size_t rest = (size_t)block.rest_block * per_block + i % per_block;
  global const LimbPose* limb = limbs + block.limb_pose;

  const RestFlutter flutter = {flutter_x, flutter_y, flutter_z, flutter_phase};
  fetch_planes(rest_x, rest_y, rest_z, rest);
  if (i % 4 == 0) fetch_flutter(&flutter, rest);  // a line of bytes holds four work-items
  real px = LOAD(rest_x, rest), py = LOAD(rest_y, rest), pz = LOAD(rest_z, rest);
#ifdef THINNED
  const float scale = block_scale[i / per_block];
  if (scale != 1.0f) {  // one for the whole block: wood and near leaves stay as they are, and their middles unread
    const real mx = LOAD(pivot_x, rest), my = LOAD(pivot_y, rest), mz = LOAD(pivot_z, rest);
    px = fma((real)(scale), px - mx, mx);
    py = fma((real)(scale), py - my, my);
    pz = fma((real)(scale), pz - mz, mz);
  }
#endif
  const PosedLanes lanes = posed_lanes(limb, &flutter, rest, px, py, pz);
  store_records(posed_records(lanes), posed, i * W);
}
