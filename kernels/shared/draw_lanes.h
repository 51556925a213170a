// W projected triangles into the visibility buffer: those whose boxes hold few pixel centres in lanes, the others one
// by one. OpenCL only.
#ifndef UNDERSTORY_DRAW_LANES_H
#define UNDERSTORY_DRAW_LANES_H

#include "kernels/shared/fetch_ahead.h"
#include "kernels/shared/few_centres.h"
#include "kernels/shared/lane_bits.h"
#include "kernels/shared/project_triangles.h"
#include "kernels/shared/scan_blocks.h"
#include "kernels/shared/scan_convert.h"
#include "kernels/shared/triangle_corners.h"

// One corner of W triangles as the scalar loop reads it.
typedef struct {
  int x[W], y[W];      // 1/256 pixel
  float inverse_z[W];  // 1/m
} CornerLanes;

static inline void store_lanes(ProjectedCorners corners, CornerLanes* lanes) {
  STORE(snapped(corners.x), lanes->x, 0);
  STORE(snapped(corners.y), lanes->y, 0);
  STORE(corners.inverse_z, lanes->inverse_z, 0);
}

static inline ScreenCorner lane_corner(const CornerLanes* lanes, int lane) {
  ScreenCorner corner;
  corner.x = lanes->x[lane];
  corner.y = lanes->y[lane];
  corner.inverse_z = lanes->inverse_z[lane];
  return corner;
}

// Fragments on their way into the visibility buffer. Whether one is nearer than what a pixel shows nobody can foretell:
// a processor that waits for the pixel to find out loses a hundred cycles, so that pixels are asked for first and
// compared later.
#define WAITING (4 * W + 16)

typedef struct {
  uint count;
  int pixel[WAITING];
  float depth[WAITING];  // m
  uint triangle[WAITING];
} WaitingFragments;

static inline void offer_waiting(WaitingFragments* waiting, size_t pixel_count, global VisibleTriangle* pixels) {
  for (uint i = 0; i < waiting->count; ++i)
    offer_fragment(pixels, pixel_count, waiting->pixel[i], waiting->depth[i], waiting->triangle[i]);
  waiting->count = 0;
}

// `first`: id of lane 0.
static inline void draw_few_centres(const CameraView* camera, FewCentres few, uint first,
                                    global VisibleTriangle* pixels) {
  const size_t pixel_count = (size_t)camera->width * camera->height;
  int pixel[W];
  float depth[W];
  WaitingFragments waiting;
  waiting.count = 0;
  whole column = (whole)(0), at = few.pixel, a = few.a.at_first, b = few.b.at_first, c = few.c.at_first;
  const whole next_row = (whole)(camera->width + 1) - few.columns;
  for (int walked = 0;; ++walked) {
    const truth in_box = walked < few.centres;
    if (lane_bits(in_box) == 0) break;
    uint left = lane_bits(in_box & ((a | b | c) >= 0));
    if (left != 0) {
      const real wb = TO_REAL(b) * few.share, wc = TO_REAL(c) * few.share;
      STORE(REAL(1.0) / fma(wb, few.to_b, fma(wc, few.to_c, few.inverse_z)), depth, 0);
      STORE(at, pixel, 0);
      while (left != 0) {
        const uint lane = next_lane(&left), place = waiting.count++;
        fetch_ahead(pixels + pixel[lane]);
        waiting.pixel[place] = pixel[lane];
        waiting.depth[place] = depth[lane];
        waiting.triangle[place] = first + lane;
      }
      if (waiting.count + W > WAITING) offer_waiting(&waiting, pixel_count, pixels);
    }
    column += 1;
    const truth ends = column == few.columns;
    a += PICK(ends, few.a.next_row, few.a.right);
    b += PICK(ends, few.b.next_row, few.b.right);
    c += PICK(ends, few.c.next_row, few.c.right);
    at += PICK(ends, next_row, (whole)(1));
    column = PICK(ends, (whole)(0), column);
  }
  offer_waiting(&waiting, pixel_count, pixels);
}

static inline void draw_triangle(const CameraView* camera, ScreenCorner a, ScreenCorner b, ScreenCorner c,
                                 float nearest, uint triangle, global VisibleTriangle* pixels) {
  const int4 box = pixel_box(camera, a, b, c);
  if (box.x > box.z || box.y > box.w) return;
  const int across =
      max(max(a.x, max(b.x, c.x)) - min(a.x, min(b.x, c.x)), max(a.y, max(b.y, c.y)) - min(a.y, min(b.y, c.y)));
  if (across <= LARGEST_SCANNED * SUBPIXELS)
    scan_blocks(camera, a, b, c, box, triangle, pixels);
  else
    scan_convert(camera, a, b, c, nearest, triangle, pixels);
}

static inline void draw_lanes(const CameraView* camera, ProjectedCorners a, ProjectedCorners b, ProjectedCorners c,
                              truth counts, uint first, global VisibleTriangle* pixels) {
  uint left = lane_bits(counts);
  if (left == 0) return;
  CornerLanes as, bs, cs;
  float nearest[W];
  STORE(min(a.z, min(b.z, c.z)) * (real)(INTERPOLATION_SLACK), nearest, 0);
  store_lanes(a, &as);
  store_lanes(b, &bs);
  store_lanes(c, &cs);
  while (left != 0) {
    const uint lane = next_lane(&left);
    draw_triangle(camera, lane_corner(&as, lane), lane_corner(&bs, lane), lane_corner(&cs, lane), nearest[lane],
                  first + lane, pixels);
  }
}

// Draws all that need no clipping; the others are left. `first`: id of lane 0.
static inline truth draw_unclipped(const CameraView* camera, ProjectedCorners a, ProjectedCorners b, ProjectedCorners c,
                                   uint first, global VisibleTriangle* pixels) {
  const whole covers = coverage(camera, a, b, c);
  const truth unclipped = covers == 1;
  if (ANY(unclipped)) {
    const FewCentres few = few_centres(camera, a, b, c, unclipped);
    draw_few_centres(camera, few, first, pixels);
    draw_lanes(camera, a, b, c, unclipped & NOT(few.few), first, pixels);
  }
  return covers == 2;
}

#endif
