// W triangles at once whose boxes hold one pixel centre each, which are most of a landscape's: the same edges, weights
// and depth as scan_convert.h, in 32 bits, since such a triangle is smaller than two pixels.
#ifndef UNDERSTORY_SINGLE_CENTRE_H
#define UNDERSTORY_SINGLE_CENTRE_H

#include "kernels/shared/project_triangles.h"

typedef struct {
  truth single;   // the triangle's box holds one centre of the image
  truth covered;  // and the triangle covers it
  whole pixel;    // of the image, row by row
  real depth;     // m
} SingleCentre;

// First pixel whose centre is at or right of `fixed`, and last whose centre is at or left of it.
static inline whole first_centres(whole fixed) { return (fixed + (SUBPIXELS / 2 - 1)) >> 8; }
static inline whole last_centres(whole fixed) { return (fixed - SUBPIXELS / 2) >> 8; }

// Of the lanes that `counts`.
static inline SingleCentre single_centre(const CameraView* camera, ProjectedCorners a, ProjectedCorners b,
                                         ProjectedCorners c, truth counts) {
  const whole ax = snapped(a.x), ay = snapped(a.y);
  whole bx = snapped(b.x), by = snapped(b.y), cx = snapped(c.x), cy = snapped(c.y);
  const whole left = first_centres(min(ax, min(bx, cx))), top = first_centres(min(ay, min(by, cy)));
  SingleCentre one;
  one.single = counts & (left == last_centres(max(ax, max(bx, cx)))) & (top == last_centres(max(ay, max(by, cy)))) &
               (left >= 0) & (left < camera->width) & (top >= 0) & (top < camera->height);
  one.pixel = top * camera->width + left;

  // Corners b and c change places where the triangle turns the other way.
  const whole turn = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay);
  const truth swapped = turn < 0;
  const whole x = bx, y = by;
  const real b_inverse = PICK(swapped, c.inverse_z, b.inverse_z), c_inverse = PICK(swapped, b.inverse_z, c.inverse_z);
  bx = PICK(swapped, cx, bx);
  by = PICK(swapped, cy, by);
  cx = PICK(swapped, x, cx);
  cy = PICK(swapped, y, cy);
  const whole x0 = left * SUBPIXELS + SUBPIXELS / 2, y0 = top * SUBPIXELS + SUBPIXELS / 2;
  const whole edge_a = (cx - bx) * (y0 - by) - (cy - by) * (x0 - bx);
  const whole edge_b = (ax - cx) * (y0 - cy) - (ay - cy) * (x0 - cx);
  const whole edge_c = (bx - ax) * (y0 - ay) - (by - ay) * (x0 - ax);
  one.covered = one.single & (turn != 0) & ((edge_a | edge_b | edge_c) >= 0);

  const real share = REAL(1.0) / TO_REAL(PICK(swapped, -turn, turn));
  const real wb = TO_REAL(edge_b) * share, wc = TO_REAL(edge_c) * share;
  one.depth = REAL(1.0) / fma(wb, b_inverse - a.inverse_z, fma(wc, c_inverse - a.inverse_z, a.inverse_z));
  return one;
}

#endif
