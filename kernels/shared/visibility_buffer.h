// Which triangle each pixel sees: the nearest, and of equals the lowest id, whatever the order of arrival.
// With 64-bit atomics one ulong holds (depth bits << 32 | triangle); without, two passes over two uint planes give
// the same pixels: RASTER_PASS 0 finds the depth, RASTER_PASS 1 the lowest triangle at that depth.
#ifndef UNDERSTORY_VISIBILITY_BUFFER_H
#define UNDERSTORY_VISIBILITY_BUFFER_H

#define NO_TRIANGLE 0xffffffffu

#if defined(UNDERSTORY_ATOMIC64) && !defined(NARROW_ATOMICS)
#pragma OPENCL EXTENSION cl_khr_int64_base_atomics : enable
#pragma OPENCL EXTENSION cl_khr_int64_extended_atomics : enable

typedef ulong VisibleTriangle;
#define NOTHING_VISIBLE 0xffffffffffffffffUL

static inline void offer_fragment(global VisibleTriangle* pixels, size_t pixels_count, size_t pixel, float depth,
                                  uint triangle) {
  const ulong offered = ((ulong)as_uint(depth) << 32) | triangle;
  global ulong* seen = pixels + pixel;
  if (offered < *seen) atom_min(seen, offered);  // the plain read avoids most atomics; a stale one costs only time
}

// Whether the pixel sees something nearer than `depth` already.
static inline int hidden(global const VisibleTriangle* pixels, size_t pixel, float depth) {
  return as_uint(depth) > (uint)(pixels[pixel] >> 32);
}

static inline uint visible_triangle(global const VisibleTriangle* pixels, size_t pixels_count, size_t pixel) {
  return (uint)pixels[pixel];
}

// Keeps the depth: nearer triangles of a later batch still show.
static inline void forget_triangle(global VisibleTriangle* pixels, size_t pixels_count, size_t pixel) {
  pixels[pixel] |= NO_TRIANGLE;
}

#else
// Plane 0: depth bits; plane 1: triangle.
typedef uint VisibleTriangle;
#define NOTHING_VISIBLE 0xffffffffu
#ifndef RASTER_PASS
#define RASTER_PASS 0
#endif

static inline void offer_fragment(global VisibleTriangle* pixels, size_t pixels_count, size_t pixel, float depth,
                                  uint triangle) {
  global uint* nearest = pixels + pixel;
#if RASTER_PASS == 0
  const uint bits = as_uint(depth);
  if (bits < *nearest) atomic_min(nearest, bits);
#else
  global uint* seen = pixels + pixels_count + pixel;
  if (as_uint(depth) == *nearest && triangle < *seen) atomic_min(seen, triangle);
#endif
}

static inline int hidden(global const VisibleTriangle* pixels, size_t pixel, float depth) {
  return as_uint(depth) > pixels[pixel];
}

static inline uint visible_triangle(global const VisibleTriangle* pixels, size_t pixels_count, size_t pixel) {
  return pixels[pixels_count + pixel];
}

static inline void forget_triangle(global VisibleTriangle* pixels, size_t pixels_count, size_t pixel) {
  pixels[pixels_count + pixel] = NO_TRIANGLE;
}
#endif

#endif
