// Trilinear look-up in 8-bit occlusion grids (sim/occlusion_grid.hpp), W fragments at a time. Each lane loads its corners
// as short vectors of neighbouring bytes: two samples along x lie side by side, so four loads serve eight corners.
#ifndef UNDERSTORY_GRID_LOOKUP_H
#define UNDERSTORY_GRID_LOOKUP_H

#include "kernels/shared/cone.h"
#include "kernels/shared/grid_record.h"

/// W fragments in one grid.
typedef struct {
  real x, y, z;   // in samples
  truth inside;   // the box holds it; false for what is not a number
  truth border;   // inside, but so near a face that occlusion has been faded
} GridPoint;

/// A component of a vector times a row of 4.
SHARED real grid_row(const global float* m, real x, real y, real z, real offset) {
  return fma(x, (real)(m[0]), fma(y, (real)(m[1]), fma(z, (real)(m[2]), offset)));
}

SHARED GridPoint grid_point(global const GridRecord* grid, real x, real y, real z) {
  const global float* m = grid->to_box;
  const real u = grid_row(m, x, y, z, (real)(m[3])), v = grid_row(m + 4, x, y, z, (real)(m[7]));
  const real w = grid_row(m + 8, x, y, z, (real)(m[11]));
  const real far_u = fabs(u), far_v = fabs(v), far_w = fabs(w);
  GridPoint p;
  p.inside = (far_u <= REAL(1.0)) & (far_v <= REAL(1.0)) & (far_w <= REAL(1.0));
  const real faded = (real)(grid->faded_from);
  p.border = p.inside & ((far_u > faded) | (far_v > faded) | (far_w > faded));
  // Samples crowd about the middle: u (1 + stretch) / (1 + stretch |u|) of the way to the last one. One division for three.
  const real stretch = (real)(grid->stretch);
  const real a = fma(stretch, far_u, REAL(1.0)), b = fma(stretch, far_v, REAL(1.0)), c = fma(stretch, far_w, REAL(1.0));
  const real scale = (REAL(1.0) + stretch) / (a * b * c);
  const real i = (real)(0.5f * ((float)grid->width - 1.0f)), j = (real)(0.5f * ((float)grid->height - 1.0f));
  const real k = (real)(0.5f * ((float)grid->depth - 1.0f));
  p.x = fma(u * (b * c), scale * i, i);
  p.y = fma(v * (a * c), scale * j, j);
  p.z = fma(w * (a * b), scale * k, k);
  return p;
}

/// The lower corner of each lane's cell, and where in it the lane is. Lanes outside get some cell of the grid.
typedef struct {
  uint sample[W];  // of the table
  float x[W], y[W], z[W];
} GridCells;

SHARED real grid_cell(real at, uint size, private real* part) {
  const real inside = at_most(at_least(at, REAL(0.0)), (real)((float)size - 1.0f));
  const real cell = at_most(floor(inside), (real)((float)size - 2.0f));
  *part = inside - cell;
  return cell;
}

/// Samples of a table: where they begin, and how many along each axis.
typedef struct {
  uint first, width, height, depth;
} GridSamples;

SHARED GridSamples samples_of(global const GridRecord* grid) {
  const GridSamples samples = {grid->first, grid->width, grid->height, grid->depth};
  return samples;
}

SHARED void grid_cells(const GridSamples of, real at_x, real at_y, real at_z, private GridCells* cells) {
  real x, y, z;
  const bits i = TO_BITS(grid_cell(at_x, of.width, &x)), j = TO_BITS(grid_cell(at_y, of.height, &y));
  const bits k = TO_BITS(grid_cell(at_z, of.depth, &z));
  const bits sample = ((k * (bits)(of.height) + j) * (bits)(of.width) + i) + (bits)(of.first);
  STORE(sample, cells->sample, 0);
  STORE(x, cells->x, 0);
  STORE(y, cells->y, 0);
  STORE(z, cells->z, 0);
}

/// Four bytes a sample, as they are, [0, 255], and the largest fourth byte of the eight samples about a point.
typedef struct {
  real x, y, z, w, largest_w;
} FourBytes;

SHARED FourBytes look_up_four(const GridSamples of, global const uchar* samples, real at_x, real at_y, real at_z) {
  GridCells cells;
  grid_cells(of, at_x, at_y, at_z, &cells);
  const size_t row = 4 * (size_t)of.width, slab = row * of.height;
  float x[W], y[W], z[W], w[W], largest_w[W];
  for (int lane = 0; lane < W; ++lane) {
    global const uchar* corner = samples + 4 * (size_t)cells.sample[lane];
    const uchar8 near_low = vload8(0, corner), near_high = vload8(0, corner + row);
    const uchar8 far_low = vload8(0, corner + slab), far_high = vload8(0, corner + slab + row);
    const uchar8 largest = max(max(near_low, near_high), max(far_low, far_high));
    largest_w[lane] = (float)max(largest.s3, largest.s7);
    const float8 a = convert_float8(near_low), b = convert_float8(near_high);
    const float8 c = convert_float8(far_low), d = convert_float8(far_high);
    const float8 up = (float8)(cells.y[lane]);
    const float8 low = fma(b - a, up, a), high = fma(d - c, up, c);
    const float8 edge = fma(high - low, (float8)(cells.z[lane]), low);
    const float4 mean = fma(edge.hi - edge.lo, (float4)(cells.x[lane]), edge.lo);
    x[lane] = mean.x;
    y[lane] = mean.y;
    z[lane] = mean.z;
    w[lane] = mean.w;
  }
  const FourBytes mean = {LOAD(x, 0), LOAD(y, 0), LOAD(z, 0), LOAD(w, 0), LOAD(largest_w, 0)};
  return mean;
}

/// A share that samples hold within the solid alone, where their neighbours lie too: then so does all of the cell.
#define SOLID_BYTE REAL(255.0)

/// Share and mean direction, in the body's frame; `samples`: packed_cone. Adds to `solid` the lanes of `inside` that are
/// within the body.
SHARED Occluded look_up_cone(global const GridRecord* grid, global const uchar* samples, const GridPoint p,
                             truth inside, private truth* solid) {
  const FourBytes mean = look_up_four(samples_of(grid), samples, p.x, p.y, p.z);
  *solid |= inside & (mean.largest_w >= SOLID_BYTE);
  const real scale = REAL(1.9685039370078740e-3);  // 1/(4 127)
  const Occluded o = {mean.w * REAL(3.9215686274509804e-3),  // 1/255
                      (mean.x - REAL(128.0)) * scale, (mean.y - REAL(128.0)) * scale, (mean.z - REAL(128.0)) * scale};
  return o;
}

/// Share of V_c that a body with an own shadow takes from its own surface at (x, y, z), unit normal (a, b, c); [0, 1].
SHARED real look_up_own(global const GridRecord* grid, global const uchar* samples, real x, real y, real z, real a,
                        real b, real c) {
  const global float* m = grid->to_box;
  const GridSamples of = {grid->own_first, grid->own_size, grid->own_size, grid->own_size};
  const float middle = 0.5f * ((float)grid->own_size - 1.0f);
  const real along = grid_row(m, x, y, z, (real)(m[3])), across = grid_row(m + 4, x, y, z, (real)(m[7]));
  const real up = grid_row(m + 8, x, y, z, (real)(m[11]));
  const FourBytes fit = look_up_four(of, samples, fma(along, (real)(grid->own_scale[0] * middle), (real)(middle)),
                                     fma(across, (real)(grid->own_scale[1] * middle), (real)(middle)),
                                     fma(up, (real)(grid->own_scale[2] * middle), (real)(middle)));
  // What the four numbers mean: sim/own_shadow.hpp. The normal in the body's frame, then (n - 128) / 127 for each.
  m = grid->axes;
  const real u = fma(a, (real)(m[0]), fma(b, (real)(m[4]), c * (real)(m[8])));
  const real v = fma(a, (real)(m[1]), fma(b, (real)(m[5]), c * (real)(m[9])));
  const real w = fma(a, (real)(m[2]), fma(b, (real)(m[6]), c * (real)(m[10])));
  const real sum = fma(fit.x - REAL(128.0), u, fma(fit.y - REAL(128.0), v, fma(fit.z - REAL(128.0), w, fit.w - REAL(128.0))));
  return at_most(at_least(sum * REAL(7.8740157480314961e-3), REAL(0.0)), REAL(1.0));
}

/// Share of a scalar grid; `samples`: one byte each. `inside`, `solid`: as above.
SHARED real look_up_share(global const GridRecord* grid, global const uchar* samples, const GridPoint p, truth inside,
                          private truth* solid) {
  GridCells cells;
  grid_cells(samples_of(grid), p.x, p.y, p.z, &cells);
  const size_t row = grid->width, slab = row * grid->height;
  float share[W], largest[W];
  for (int lane = 0; lane < W; ++lane) {
    global const uchar* corner = samples + cells.sample[lane];
    const uchar2 near_low = vload2(0, corner), near_high = vload2(0, corner + row);
    const uchar2 far_low = vload2(0, corner + slab), far_high = vload2(0, corner + slab + row);
    const uchar2 both = max(max(near_low, near_high), max(far_low, far_high));
    largest[lane] = (float)max(both.x, both.y);
    const float2 a = convert_float2(near_low), b = convert_float2(near_high);
    const float2 c = convert_float2(far_low), d = convert_float2(far_high);
    const float2 up = (float2)(cells.y[lane]);
    const float2 low = fma(b - a, up, a), high = fma(d - c, up, c);
    const float2 edge = fma(high - low, (float2)(cells.z[lane]), low);
    share[lane] = fma(edge.y - edge.x, cells.x[lane], edge.x);
  }
  *solid |= inside & (LOAD(largest, 0) >= SOLID_BYTE);
  return LOAD(share, 0) * REAL(3.9215686274509804e-3);
}

/// The mean direction in world axes.
SHARED Occluded to_world(global const GridRecord* grid, const Occluded o) {
  const global float* m = grid->axes;
  Occluded w;
  w.share = o.share;
  w.x = fma(o.x, (real)(m[0]), fma(o.y, (real)(m[1]), o.z * (real)(m[2])));
  w.y = fma(o.x, (real)(m[4]), fma(o.y, (real)(m[5]), o.z * (real)(m[6])));
  w.z = fma(o.x, (real)(m[8]), fma(o.y, (real)(m[9]), o.z * (real)(m[10])));
  return w;
}

#endif
