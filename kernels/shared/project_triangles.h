// W triangles at once from posed corners to the screen, and which of them may cover a pixel centre. Most triangles of a
// landscape are smaller than a pixel and miss every centre: this straight-line code leaves few for the scalar loop.
#ifndef UNDERSTORY_PROJECT_TRIANGLES_H
#define UNDERSTORY_PROJECT_TRIANGLES_H

#include "kernels/shared/guard_band.h"
#include "kernels/shared/posed_vertices.h"

#define SUBPIXELS 256  // corners snap to 1/256 pixel

typedef struct {
  real x, y;       // pixels from the top left of the image
  real inverse_z;  // 1/m
  real z;          // metres ahead of the eye
} ProjectedCorners;

static inline real along(const float* axis, PosedLanes p) {
  return fma((real)(axis[0]), p.x, fma((real)(axis[1]), p.y, (real)(axis[2]) * p.z));
}

static inline ProjectedCorners project_corners(const CameraView* camera, PosedLanes p) {
  ProjectedCorners corners;
  corners.z = along(camera->forward, p);
  corners.inverse_z = REAL(1.0) / corners.z;
  const real scale = (real)(camera->focal) * corners.inverse_z;
  corners.x = fma(along(camera->right, p), scale, (real)(camera->centre_x));
  corners.y = fma(along(camera->down, p), scale, (real)(camera->centre_y));
  return corners;
}

// The nearest whole number for |x| < 2^22, by the rounding of an addition: rint is ten times as many instructions on
// vectors in PoCL. Farther out the error stays small beside x, which is all that holds_centre needs there.
static inline real nearest_whole(real x) { return (x + REAL(12582912.0)) - REAL(12582912.0); }

// 1/256 pixels, to the nearest (upwards at half) where x >= 0, in the image. Left of it corners move by one step at
// most, and always alike.
static inline whole snapped(real x) { return TO_WHOLE(fma(x, (real)(SUBPIXELS), REAL(0.5))); }

// Whether [low, high] reaches the image and holds a pixel centre, at a whole number and a half: the one nearest to the
// middle decides. Corners still have to snap, so the interval is widened by one step.
static inline truth holds_centre(real low, real high, int pixels) {
  const real middle = REAL(0.5) * (low + high) - REAL(0.5), reach = REAL(0.5) * (high - low) + REAL(0.00390625);
  return (fabs(nearest_whole(middle) - middle) <= reach) & (middle + reach >= REAL(0.0)) &
         (middle - reach <= (real)((float)(pixels - 1)));
}

// Per lane: 0 covers no centre, 1 scan-convert, 2 clip first.
static inline whole coverage(const CameraView* camera, ProjectedCorners a, ProjectedCorners b, ProjectedCorners c) {
  const real low_x = min(a.x, min(b.x, c.x)), high_x = max(a.x, max(b.x, c.x));
  const real low_y = min(a.y, min(b.y, c.y)), high_y = max(a.y, max(b.y, c.y));
  const real near_plane = (real)(camera->near_plane), guard = (real)(GUARD_BAND);
  const truth covers = holds_centre(low_x, high_x, camera->width) & holds_centre(low_y, high_y, camera->height);
  const truth ahead = max(a.z, max(b.z, c.z)) > near_plane;
  const truth unclipped =
      (min(a.z, min(b.z, c.z)) > near_plane) & (max(-low_x, high_x) < guard) & (max(-low_y, high_y) < guard);
  return PICK(ahead & unclipped & covers, (whole)(1), PICK(ahead & NOT(unclipped), (whole)(2), (whole)(0)));
}

#endif
