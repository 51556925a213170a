// One small triangle into the visibility buffer, W pixels of its box at a time: the same edges, weights and depth as
// scan_convert.h, in 32 bits.
#ifndef UNDERSTORY_SCAN_BLOCKS_H
#define UNDERSTORY_SCAN_BLOCKS_H

#include "kernels/shared/lane_bits.h"
#include "kernels/shared/scan_convert.h"

#define LARGEST_SCANNED 63  // pixels across: products of 1/256 pixels stay below 2^31

#define BLOCK_COLUMNS (W == 1 ? 1 : 4)
#define BLOCK_ROWS (W / BLOCK_COLUMNS)

// An edge function of W pixels: `first` of the block's first pixel, and its steps to the right and down.
static inline whole edge_lanes(int first, int right, int down) {
  const whole lane = LANE_NUMBERS;
  return (whole)(first) + (lane % BLOCK_COLUMNS) * (whole)(right) + (lane / BLOCK_COLUMNS) * (whole)(down);
}

// The pixels `box` of the image (left, top, right, bottom), at most LARGEST_SCANNED + 1 each way.
static inline void scan_blocks(const CameraView* camera, ScreenCorner a, ScreenCorner b, ScreenCorner c, int4 box,
                               uint triangle, global VisibleTriangle* pixels) {
  int area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
  if (area == 0) return;
  if (area < 0) {
    const ScreenCorner swap = b;
    b = c;
    c = swap;
    area = -area;
  }
  const int x0 = box.x * SUBPIXELS + SUBPIXELS / 2, y0 = box.y * SUBPIXELS + SUBPIXELS / 2;
  const int a_right = (b.y - c.y) * SUBPIXELS, a_down = (c.x - b.x) * SUBPIXELS;
  const int b_right = (c.y - a.y) * SUBPIXELS, b_down = (a.x - c.x) * SUBPIXELS;
  const int c_right = (a.y - b.y) * SUBPIXELS, c_down = (b.x - a.x) * SUBPIXELS;
  const whole edge_a_box = edge_lanes((c.x - b.x) * (y0 - b.y) - (c.y - b.y) * (x0 - b.x), a_right, a_down);
  const whole edge_b_box = edge_lanes((a.x - c.x) * (y0 - c.y) - (a.y - c.y) * (x0 - c.x), b_right, b_down);
  const whole edge_c_box = edge_lanes((b.x - a.x) * (y0 - a.y) - (b.y - a.y) * (x0 - a.x), c_right, c_down);
  const whole lane = LANE_NUMBERS, column = lane % BLOCK_COLUMNS, row = lane / BLOCK_COLUMNS;
  const real share = (real)(1.0f / (float)area), nearest = (real)(a.inverse_z);
  const real to_b = (real)(b.inverse_z - a.inverse_z), to_c = (real)(c.inverse_z - a.inverse_z);
  const size_t pixel_count = (size_t)camera->width * camera->height;

  for (int y = box.y; y <= box.w; y += BLOCK_ROWS) {
    for (int x = box.x; x <= box.z; x += BLOCK_COLUMNS) {
      const int right = x - box.x, down = y - box.y;
      const whole edge_a = edge_a_box + (whole)(right * a_right + down * a_down);
      const whole edge_b = edge_b_box + (whole)(right * b_right + down * b_down);
      const whole edge_c = edge_c_box + (whole)(right * c_right + down * c_down);
      const truth inside = ((edge_a | edge_b | edge_c) >= 0) & (column <= box.z - x) & (row <= box.w - y);
      uint covered = lane_bits(inside);
      if (covered == 0) continue;
      const real wb = TO_REAL(edge_b) * share, wc = TO_REAL(edge_c) * share;
      float depth[W];
      STORE(REAL(1.0) / fma(wb, to_b, fma(wc, to_c, nearest)), depth, 0);
      const size_t first = (size_t)y * camera->width + x;
      while (covered != 0) {
        const uint k = next_lane(&covered);
        offer_fragment(pixels, pixel_count, first + k / BLOCK_COLUMNS * camera->width + k % BLOCK_COLUMNS, depth[k],
                       triangle);
      }
    }
  }
}

#endif
