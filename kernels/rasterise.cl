// Scan-converts triangles into the visibility buffer. Corners snap to 1/256 pixel and edges are exact integers,
// inclusive: neighbours that share an edge leave no crack. Depth is perspective-correct (1/z is linear on screen).
// One work-group per chunk; one work-item projects and culls W triangles in vector lanes, then draws those that are
// left.
#pragma OPENCL FP_CONTRACT OFF
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

// `first`: id of lane 0.
static inline void draw_few_centres(const CameraView* camera, FewCentres few, uint first,
                                    global VisibleTriangle* pixels) {
  const size_t pixel_count = (size_t)camera->width * camera->height;
  int pixel[W];
  float depth[W];
  whole column = (whole)(0), at = few.pixel, a = few.a.at_first, b = few.b.at_first, c = few.c.at_first;
  const whole next_row = (whole)(camera->width + 1) - few.columns;
  for (int walked = 0;; ++walked) {
    const truth in_box = walked < few.centres;
    if (lane_bits(in_box) == 0) return;
    uint left = lane_bits(in_box & ((a | b | c) >= 0));
    if (left != 0) {
      const real wb = TO_REAL(b) * few.share, wc = TO_REAL(c) * few.share;
      STORE(REAL(1.0) / fma(wb, few.to_b, fma(wc, few.to_c, few.inverse_z)), depth, 0);
      STORE(at, pixel, 0);
      while (left != 0) {
        const uint lane = next_lane(&left);
        offer_fragment(pixels, pixel_count, pixel[lane], depth[lane], first + lane);
      }
    }
    column += 1;
    const truth ends = column == few.columns;
    a += PICK(ends, few.a.next_row, few.a.right);
    b += PICK(ends, few.b.next_row, few.b.right);
    c += PICK(ends, few.c.next_row, few.c.right);
    at += PICK(ends, next_row, (whole)(1));
    column = PICK(ends, (whole)(0), column);
  }
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

// Draws all that need no clipping; the others are left. `covers`: coverage per lane.
static inline truth draw_unclipped(const CameraView* camera, ProjectedCorners a, ProjectedCorners b, ProjectedCorners c,
                                   whole covers, uint first, global VisibleTriangle* pixels) {
  const truth unclipped = covers == 1;
  if (ANY(unclipped)) {
    const FewCentres few = few_centres(camera, a, b, c, unclipped);
    draw_few_centres(camera, few, first, pixels);
    draw_lanes(camera, a, b, c, unclipped & NOT(few.few), first, pixels);
  }
  return covers == 2;
}

kernel void clear_visible(global VisibleTriangle* pixels, uint count) {
  const uint i = get_global_id(0);
  if (i < count) pixels[i] = NOTHING_VISIBLE;
}

kernel void rasterise_mesh(global const TriangleChunk* chunks, global const uint* index_a, global const uint* index_b,
                           global const uint* index_c, global const float4* posed, const CameraView camera,
                           global VisibleTriangle* pixels) {
  const uint id = get_global_id(0) * W, lane = id % CHUNK;  // whatever size of work-group the device grants
  global const TriangleChunk* chunk = chunks + id / CHUNK;
  if (lane >= chunk->count) return;
  const uint t = chunk->first_index + lane;
  const uint first = chunk->first_vertex;
  const ProjectedCorners a = project_corners(&camera, gather_posed(posed, first, index_a + t));
  const ProjectedCorners b = project_corners(&camera, gather_posed(posed, first, index_b + t));
  const ProjectedCorners c = project_corners(&camera, gather_posed(posed, first, index_c + t));
  const truth clipped = draw_unclipped(&camera, a, b, c, coverage(&camera, a, b, c), id, pixels);
  for (uint left = lane_bits(clipped); left != 0;) {
    const uint i = next_lane(&left);
    clip_and_scan_convert(&camera, mesh_corners(chunk, lane + i, index_a, index_b, index_c), posed, id + i, pixels);
  }
}

kernel void rasterise_grass(global const TriangleChunk* chunks, uint first_chunk, global const float4* posed,
                            const CameraView camera, global VisibleTriangle* pixels) {
  const uint id = first_chunk * CHUNK + get_global_id(0) * W, lane = id % CHUNK;
  global const TriangleChunk* chunk = chunks + id / CHUNK;
  if (lane >= chunk->count) return;
  const Corners corners = grass_corners(chunk, lane);
  const ProjectedCorners a = project_corners(&camera, load_posed(posed, corners.a));
  const ProjectedCorners b = project_corners(&camera, load_posed(posed, corners.b));
  const ProjectedCorners c = project_corners(&camera, load_posed(posed, corners.c));
  const truth clipped = draw_unclipped(&camera, a, b, c, coverage(&camera, a, b, c), id, pixels);
  for (uint left = lane_bits(clipped); left != 0;) {
    const uint i = next_lane(&left);
    clip_and_scan_convert(&camera, grass_corners(chunk, lane + i), posed, id + i, pixels);
  }
}
