// The farthest depth that each tile of FARTHEST_TILE x FARTHEST_TILE pixels of a visibility buffer shows, m; infinite
// where some pixel of it shows nothing. What lies behind it everywhere is hidden (hierarchical z: Greene, Kass, Miller
// 1993, "Hierarchical Z-buffer visibility", SIGGRAPH, section 3.2, of one level). One work-item per tile; the buffer
// with 64-bit words (visibility_buffer.h).
#include "kernels/shared/farthest_depth.h"

kernel void farthest_depth(global const ulong* pixels, uint width, uint height, global float* farthest) {
  const uint columns = farthest_tiles(width), tile = get_global_id(0);
  if (tile >= columns * farthest_tiles(height)) return;
  const uint left = tile % columns * FARTHEST_TILE, top = tile / columns * FARTHEST_TILE;
  const uint right = min(left + FARTHEST_TILE, width), bottom = min(top + FARTHEST_TILE, height);
  uint far = 0;  // bits of depths above 0 are in their order, and those of "nothing" beyond all of them
  for (uint y = top; y < bottom; ++y)
    for (uint x = left; x < right; ++x) far = max(far, (uint)(pixels[(size_t)y * width + x] >> 32));
  farthest[tile] = far < as_uint(INFINITY) ? as_float(far) : INFINITY;
}
