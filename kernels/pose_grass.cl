// Bends every blade of one field in the wind of time t and writes its 7 vertices. One work-item per W blades, one
// work-group per 256: vertex k of lane l goes to 7 * 256 * group + 256 k + l, so that stores and triangle corners are
// contiguous (triangle_corners.h).
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/bent_blades.h"
#include "kernels/shared/triangle_corners.h"

static inline PosedRecords moved_along(PosedRecords from, BladePoint way) {
  const PosedLanes lanes = {way.x, way.y, way.z};
  return moved_by(from, 1.0f, posed_records(lanes));
}

// Two vertices, `share` of `across` to the left and to the right of the midline.
static inline void store_pair(global float4* posed, uint vertex, PosedRecords middle, float share,
                              PosedRecords across) {
  store_records(moved_by(middle, -share, across), posed, vertex);
  store_records(moved_by(middle, share, across), posed, vertex + CHUNK);
}

kernel void pose_grass(REST_BLADES, const GrassWind wind, global const float2* series, uint first_blade,
                       uint first_vertex, global float4* posed) {
  const size_t blade = first_blade / W + get_global_id(0);
  const uint lane = get_global_id(0) * W;  // whatever size of work-group the device grants
  const uint vertex = first_vertex + 7 * CHUNK * (lane / CHUNK) + lane % CHUNK;
#if W > 1
  fetch_blades(REST_BLADE_NAMES, blade + FETCH_DISTANCE / W);
#endif
  const BentBlades blades = bent_blades(REST_BLADE_NAMES, wind, series, blade, 1.0f);
  const PosedRecords root = posed_records(blades.foot), across = posed_records(blades.across);
  store_pair(posed, vertex, root, 1.0f, across);
  store_pair(posed, vertex + 2 * CHUNK, moved_along(root, on_midline(&blades, 0.4f)), 0.85f, across);
  store_pair(posed, vertex + 4 * CHUNK, moved_along(root, on_midline(&blades, 0.75f)), 0.5f, across);
  store_records(moved_along(root, on_midline(&blades, 1.0f)), posed, vertex + 6 * CHUNK);
}
