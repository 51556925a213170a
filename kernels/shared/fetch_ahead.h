// Asks for memory that is read soon, where a processor cannot foresee it: at the start of a page or of a tile's next
// row, or at places that a table names. A GPU hides such waits by itself, and OpenCL's own prefetch does nothing in
// PoCL.
#ifndef UNDERSTORY_FETCH_AHEAD_H
#define UNDERSTORY_FETCH_AHEAD_H

#include "kernels/shared/real.h"

// Places need not exist: nothing is read.
static inline void fetch_ahead(global const void* place) {
#if defined(__x86_64__) || defined(__aarch64__)
  __builtin_prefetch((const void*)(size_t)place);
#else
  (void)place;
#endif
}

// How far ahead work-items ask for planes, elements: 2 KiB, half of what a work-group of a streaming kernel reads of
// one.
#define FETCH_DISTANCE 512

/// What work-item i + FETCH_DISTANCE / W will read of a plane of 4-byte elements. At W = 1 the compiler makes vectors
/// of neighbouring work-items, and processors foresee those.
static inline void fetch_plane(global const void* plane, size_t i) {
#if W > 1
  fetch_ahead((global const char*)plane + 4 * (i * W + FETCH_DISTANCE));
#endif
}

/// The same of a plane of bytes.
static inline void fetch_bytes(global const void* plane, size_t i) {
#if W > 1
  fetch_ahead((global const char*)plane + i * W + FETCH_DISTANCE);
#endif
}

/// Where the units of a list lie nobody can foresee either: so many units ahead of the one that is drawn.
#define UNITS_AHEAD 3

static inline void fetch_planes(global const void* x, global const void* y, global const void* z, size_t i) {
  fetch_plane(x, i);
  fetch_plane(y, i);
  fetch_plane(z, i);
}

#endif
