// One triangle into the visibility buffer: exact integer edges, inclusive on all sides.
#ifndef UNDERSTORY_SCAN_CONVERT_H
#define UNDERSTORY_SCAN_CONVERT_H

#include "kernels/shared/guard_band.h"
#include "kernels/shared/project_triangles.h"
#include "kernels/shared/triangle_corners.h"
#include "kernels/shared/visibility_buffer.h"

#define INTERPOLATION_SLACK 0.99999f  // interpolated depths may round to just before the nearest corner

typedef struct {
  int x, y;         // 1/256 pixel
  float inverse_z;  // 1/m
} ScreenCorner;

// First pixel whose centre is at or right of `fixed`, and last whose centre is at or left of it.
static inline int first_centre(int fixed) { return (fixed + SUBPIXELS / 2 - 1) >> 8; }
static inline int last_centre(int fixed) { return (fixed - SUBPIXELS / 2) >> 8; }

// The pixels whose centres may lie in the triangle, first and last column and row: left, top, right, bottom.
static inline int4 pixel_box(const CameraView* camera, ScreenCorner a, ScreenCorner b, ScreenCorner c) {
  return (int4)(max(first_centre(min(a.x, min(b.x, c.x))), 0), max(first_centre(min(a.y, min(b.y, c.y))), 0),
                min(last_centre(max(a.x, max(b.x, c.x))), camera->width - 1),
                min(last_centre(max(a.y, max(b.y, c.y))), camera->height - 1));
}

// `nearest`: no part of the triangle is nearer, m. Fragments that the buffer hides already are not worth their maths;
// in foliage that is most of them.
static inline void scan_convert(const CameraView* camera, ScreenCorner a, ScreenCorner b, ScreenCorner c, float nearest,
                                uint triangle, global VisibleTriangle* pixels) {
  const int4 box = pixel_box(camera, a, b, c);
  const int left = box.x, top = box.y, right = box.z, bottom = box.w;
  if (left > right || top > bottom) return;
  const size_t first_pixel = (size_t)top * camera->width + left;
  if (left == right && top == bottom && hidden(pixels, first_pixel, nearest)) return;
  long area = (long)(b.x - a.x) * (c.y - a.y) - (long)(c.x - a.x) * (b.y - a.y);
  if (area == 0) return;
  if (area < 0) {
    const ScreenCorner swap = b;
    b = c;
    c = swap;
    area = -area;
  }
  // Edge functions at the first pixel centre, and their steps per pixel.
  const int x0 = left * SUBPIXELS + SUBPIXELS / 2, y0 = top * SUBPIXELS + SUBPIXELS / 2;
  long edge_a_row = (long)(c.x - b.x) * (y0 - b.y) - (long)(c.y - b.y) * (x0 - b.x);
  long edge_b_row = (long)(a.x - c.x) * (y0 - c.y) - (long)(a.y - c.y) * (x0 - c.x);
  long edge_c_row = (long)(b.x - a.x) * (y0 - a.y) - (long)(b.y - a.y) * (x0 - a.x);
  const long a_right = (long)(b.y - c.y) * SUBPIXELS, a_down = (long)(c.x - b.x) * SUBPIXELS;
  const long b_right = (long)(c.y - a.y) * SUBPIXELS, b_down = (long)(a.x - c.x) * SUBPIXELS;
  const long c_right = (long)(a.y - b.y) * SUBPIXELS, c_down = (long)(b.x - a.x) * SUBPIXELS;
  const float share = 1.0f / (float)area;
  const size_t pixel_count = (size_t)camera->width * camera->height;

  for (int y = top; y <= bottom; ++y) {
    long edge_a = edge_a_row, edge_b = edge_b_row, edge_c = edge_c_row;
    for (int x = left; x <= right; ++x) {
      const size_t pixel = (size_t)y * camera->width + x;
      if ((edge_a | edge_b | edge_c) >= 0 && !hidden(pixels, pixel, nearest)) {
        const float wb = (float)edge_b * share, wc = (float)edge_c * share;
        const float inverse_z = fma(wb, b.inverse_z - a.inverse_z, fma(wc, c.inverse_z - a.inverse_z, a.inverse_z));
        offer_fragment(pixels, pixel_count, pixel, 1.0f / inverse_z, triangle);
      }
      edge_a += a_right;
      edge_b += b_right;
      edge_c += c_right;
    }
    edge_a_row += a_down;
    edge_b_row += b_down;
    edge_c_row += c_down;
  }
}

// As project_corners and snapped do it for W at once: a clipped triangle meets its neighbours at the same corners.
static inline ScreenCorner screen_corner(const CameraView* camera, ViewPoint v) {
  ScreenCorner s;
  s.inverse_z = 1.0f / v.z;
  const float scale = camera->focal * s.inverse_z;
  s.x = convert_int(fma(fma(v.x, scale, camera->centre_x), SUBPIXELS, 0.5f));
  s.y = convert_int(fma(fma(v.y, scale, camera->centre_y), SUBPIXELS, 0.5f));
  return s;
}

static inline ViewPoint posed_view_point(const CameraView* camera, float4 vertex) {
  return view_point(camera, vertex.x, vertex.y, vertex.z);
}

// For the few triangles that pass the near plane or leave the guard band.
static inline void clip_and_scan_convert(const CameraView* camera, Corners corners, global const float4* posed,
                                         uint triangle, global VisibleTriangle* pixels) {
  ViewPoint polygon[CLIPPED_CORNERS];
  polygon[0] = posed_view_point(camera, posed[corners.a]);
  polygon[1] = posed_view_point(camera, posed[corners.b]);
  polygon[2] = posed_view_point(camera, posed[corners.c]);
  const int count = clip_to_guard_band(camera, polygon);
  if (count < 3) return;
  float nearest = polygon[0].z;
  for (int i = 1; i < count; ++i) nearest = fmin(nearest, polygon[i].z);
  nearest *= INTERPOLATION_SLACK;
  const ScreenCorner first = screen_corner(camera, polygon[0]);
  ScreenCorner previous = screen_corner(camera, polygon[1]);
  for (int i = 2; i < count; ++i) {
    const ScreenCorner next = screen_corner(camera, polygon[i]);
    scan_convert(camera, first, previous, next, nearest, triangle, pixels);
    previous = next;
  }
}

#endif
