// W triangles at once whose boxes hold few pixel centres, which are most of a landscape's: the same edges, weights and
// depth as scan_convert.h, in 32 bits. Every lane walks through its own box, row by row, whatever shape the others have.
#ifndef UNDERSTORY_FEW_CENTRES_H
#define UNDERSTORY_FEW_CENTRES_H

#include "kernels/shared/project_triangles.h"

// Larger boxes keep too many lanes waiting. Products of 1/256 pixels stay far below 2^31.
#define FEW_CENTRES 96
#define FEW_ACROSS 32

typedef struct {
  whole at_first, right, next_row;  // of the edge function: at the box's first centre, and its steps to the next one
} EdgeLanes;

typedef struct {
  truth few;                   // the triangle's box holds few centres, all of the image
  whole centres, columns;      // of the box; no centres where there is nothing to draw
  whole pixel;                 // its first one, row by row
  EdgeLanes a, b, c;           // inside: all of them 0 and more
  real share;                  // of the triangle's area, per unit of an edge
  real inverse_z, to_b, to_c;  // 1/m: of corner a, and the others' difference from it
} FewCentres;

// First pixel whose centre is at or right of `fixed`, and last whose centre is at or left of it.
static inline whole first_centres(whole fixed) { return (fixed + (SUBPIXELS / 2 - 1)) >> 8; }
static inline whole last_centres(whole fixed) { return (fixed - SUBPIXELS / 2) >> 8; }

static inline EdgeLanes edge_from(whole x, whole y, whole to_x, whole to_y, whole x0, whole y0, whole columns) {
  EdgeLanes edge;
  edge.at_first = (to_x - x) * (y0 - y) - (to_y - y) * (x0 - x);
  edge.right = (y - to_y) * SUBPIXELS;
  edge.next_row = (to_x - x) * SUBPIXELS - edge.right * (columns - 1);
  return edge;
}

// Of the lanes that `counts`.
static inline FewCentres few_centres(const CameraView* camera, ProjectedCorners a, ProjectedCorners b,
                                     ProjectedCorners c, truth counts) {
  const whole ax = snapped(a.x), ay = snapped(a.y);
  whole bx = snapped(b.x), by = snapped(b.y), cx = snapped(c.x), cy = snapped(c.y);
  const whole left = first_centres(min(ax, min(bx, cx))), top = first_centres(min(ay, min(by, cy)));
  const whole right = last_centres(max(ax, max(bx, cx))), bottom = last_centres(max(ay, max(by, cy)));
  FewCentres few;
  few.columns = right - left + 1;
  const whole rows = bottom - top + 1;
  few.centres = few.columns * rows;
  few.few = counts & (few.columns <= FEW_ACROSS) & (rows <= FEW_ACROSS) & (few.centres <= FEW_CENTRES) & (left >= 0) &
            (right < camera->width) & (top >= 0) & (bottom < camera->height);
  few.pixel = top * camera->width + left;

  // Corners b and c change places where the triangle turns the other way.
  const whole turn = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay);
  const truth swapped = turn < 0;
  const whole x = bx, y = by;
  bx = PICK(swapped, cx, bx);
  by = PICK(swapped, cy, by);
  cx = PICK(swapped, x, cx);
  cy = PICK(swapped, y, cy);
  const whole x0 = left * SUBPIXELS + SUBPIXELS / 2, y0 = top * SUBPIXELS + SUBPIXELS / 2;
  few.a = edge_from(bx, by, cx, cy, x0, y0, few.columns);
  few.b = edge_from(cx, cy, ax, ay, x0, y0, few.columns);
  few.c = edge_from(ax, ay, bx, by, x0, y0, few.columns);
  few.share = REAL(1.0) / TO_REAL(PICK(swapped, -turn, turn));
  few.inverse_z = a.inverse_z;
  few.to_b = PICK(swapped, c.inverse_z, b.inverse_z) - a.inverse_z;
  few.to_c = PICK(swapped, b.inverse_z, c.inverse_z) - a.inverse_z;
  // Without area all edges may be 0: such a triangle covers nothing.
  few.centres = PICK(few.few & (turn != 0) & (few.columns > 0), few.centres, (whole)(0));
  return few;
}

#endif
