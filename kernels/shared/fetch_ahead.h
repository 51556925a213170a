// Asks for memory that is read soon, where a processor cannot foresee it: at the start of a tile's next row, say. A GPU
// hides such waits by itself, and OpenCL's own prefetch does nothing in PoCL.
#ifndef UNDERSTORY_FETCH_AHEAD_H
#define UNDERSTORY_FETCH_AHEAD_H

static inline void fetch_ahead(global const void* place) {
#if defined(__x86_64__) || defined(__aarch64__)
  __builtin_prefetch((const void*)(size_t)place);
#else
  (void)place;
#endif
}

#endif
