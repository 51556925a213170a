// Normals for images that have none: the cross product of the steps to the nearer neighbour in each direction of the
// image, turned to the viewer, in world axes. Where no neighbour is drawn it faces the viewer. One work-item per pixel.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/obscurance_setting.h"
#include "kernels/shared/validity.h"

typedef struct {
  float x, y, z;  // camera axes: right, down, forward
} CameraPoint;

static inline CameraPoint point_at(int x, int y, float depth, const ObscuranceSetting* setting) {
  const float scale = (setting->perspective > 0.5f ? depth : 1.0f) / setting->focal;
  CameraPoint point;
  point.x = ((float)x + 0.5f - setting->centre_x) * scale;
  point.y = ((float)y + 0.5f - setting->centre_y) * scale;
  point.z = depth;
  return point;
}

/// From the pixel (x, y) at `own` to the drawn neighbour on either side whose depth is nearer; 0 without one.
static inline CameraPoint step_along(global const float* depth, global const uint* validity, int x, int y, int step_x,
                                     int step_y, CameraPoint own, const ObscuranceSetting* setting) {
  CameraPoint best = {0, 0, 0};
  float least = INFINITY;
  for (int side = -1; side <= 1; side += 2) {
    const int there_x = x + side * step_x, there_y = y + side * step_y;
    if (there_x < 0 || there_y < 0 || there_x >= setting->width || there_y >= setting->height) continue;
    const int there = there_y * setting->width + there_x;
    if (validity[there] & (VALIDITY_BACKGROUND | VALIDITY_NOT_FINITE)) continue;
    const CameraPoint point = point_at(there_x, there_y, depth[there], setting);
    const float apart = fabs(point.z - own.z);
    if (!(apart < least)) continue;
    least = apart;
    best.x = (float)side * (point.x - own.x);
    best.y = (float)side * (point.y - own.y);
    best.z = (float)side * (point.z - own.z);
  }
  return best;
}

kernel void make_normals(global const float* depth, global const uint* validity, const ObscuranceSetting setting,
                         uint padded, global float* normal_x, global float* normal_y, global float* normal_z) {
  const uint i = get_global_id(0);
  if (i >= padded) return;
  const int x = (int)(i % (uint)setting.width), y = (int)(i / (uint)setting.width);
  float a = 0, b = 0, c = 0;
  if (y < setting.height && !(validity[i] & (VALIDITY_BACKGROUND | VALIDITY_NOT_FINITE))) {
    const CameraPoint own = point_at(x, y, depth[i], &setting);
    const CameraPoint u = step_along(depth, validity, x, y, 1, 0, own, &setting);
    const CameraPoint v = step_along(depth, validity, x, y, 0, 1, own, &setting);
    // Right times down points away from the viewer, along forward.
    a = u.z * v.y - u.y * v.z;
    b = u.x * v.z - u.z * v.x;
    c = u.y * v.x - u.x * v.y;
    const float square = a * a + b * b + c * c;
    const bool perspective = setting.perspective > 0.5f;
    const float ray_x = perspective ? own.x : 0.0f, ray_y = perspective ? own.y : 0.0f, ray_z = perspective ? own.z : 1.0f;
    if (!(square > 0) || !(square < INFINITY)) {
      a = -ray_x;
      b = -ray_y;
      c = -ray_z;
    }
    const float facing = a * ray_x + b * ray_y + c * ray_z;
    const float scale = rsqrt(fmax(a * a + b * b + c * c, 1e-37f)) * (facing > 0 ? -1.0f : 1.0f);
    a *= scale;
    b *= scale;
    c *= scale;
  }
  normal_x[i] = a * setting.right[0] + b * setting.down[0] + c * setting.forward[0];
  normal_y[i] = a * setting.right[1] + b * setting.down[1] + c * setting.forward[1];
  normal_z[i] = a * setting.right[2] + b * setting.down[2] + c * setting.forward[2];
}
