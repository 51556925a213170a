// Pinhole projection of camera-relative points (world axes) into the image: x right, y down, pixel centres at +0.5.
#ifndef UNDERSTORY_CAMERA_H
#define UNDERSTORY_CAMERA_H

#include "kernels/shared/records.h"

typedef struct {
  float x, y, z;  // metres to the right, down, and forward of the eye
} ViewPoint;

static inline ViewPoint view_point(const CameraView* camera, float x, float y, float z) {
  ViewPoint v;
  v.x = fma(camera->right[0], x, fma(camera->right[1], y, camera->right[2] * z));
  v.y = fma(camera->down[0], x, fma(camera->down[1], y, camera->down[2] * z));
  v.z = fma(camera->forward[0], x, fma(camera->forward[1], y, camera->forward[2] * z));
  return v;
}

#endif
