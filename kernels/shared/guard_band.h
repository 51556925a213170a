// Clipping of a view-space triangle by the near plane and a guard band around the image, for the few triangles that
// need it. Inside, corners fit the rasteriser's fixed point: |x - centre| below GUARD_BAND pixels.
#ifndef UNDERSTORY_GUARD_BAND_H
#define UNDERSTORY_GUARD_BAND_H

#include "kernels/shared/camera.h"

#define GUARD_BAND 16384.0f
#define CLIPPED_CORNERS 8  // a triangle cut by five planes has at most eight corners

// Signed distance (any positive scale) of a point to clip plane 0..4: near, left, right, top, bottom.
static inline float clip_distance(const CameraView* camera, ViewPoint v, int plane) {
  const float side = v.z * (GUARD_BAND * 0.999f), x = v.x * camera->focal, y = v.y * camera->focal;
  switch (plane) {
    case 0:
      return v.z - camera->near_plane;
    case 1:
      return side + x;
    case 2:
      return side - x;
    case 3:
      return side + y;
    default:
      return side - y;
  }
}

// Sutherland-Hodgman. `polygon` holds three corners on entry; returns how many it holds on exit (0: nothing left).
static inline int clip_to_guard_band(const CameraView* camera, ViewPoint* polygon) {
  ViewPoint kept[CLIPPED_CORNERS];
  int count = 3;
  for (int plane = 0; plane < 5 && count > 0; ++plane) {
    int kept_count = 0;
    for (int i = 0; i < count; ++i) {
      const ViewPoint from = polygon[i], to = polygon[i + 1 < count ? i + 1 : 0];
      const float from_distance = clip_distance(camera, from, plane), to_distance = clip_distance(camera, to, plane);
      if (from_distance >= 0) kept[kept_count++] = from;
      if ((from_distance >= 0) != (to_distance >= 0)) {
        // From the inside outwards, so that two triangles that share the edge cut it at the same point.
        const int outwards = from_distance >= 0;
        const ViewPoint inner = outwards ? from : to, outer = outwards ? to : from;
        const float inside = outwards ? from_distance : to_distance, outside = outwards ? to_distance : from_distance;
        const float share = inside / (inside - outside);
        ViewPoint cut;
        cut.x = fma(share, outer.x - inner.x, inner.x);
        cut.y = fma(share, outer.y - inner.y, inner.y);
        cut.z = plane == 0 ? camera->near_plane : fma(share, outer.z - inner.z, inner.z);
        kept[kept_count++] = cut;
      }
    }
    count = kept_count;
    for (int i = 0; i < count; ++i) polygon[i] = kept[i];
  }
  return count;
}

#endif
